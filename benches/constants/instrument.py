"""Makes the constants in a copy of the source adjustable: `instrument.py COPY`, where COPY is a clone that is thrown away afterwards.

Each `const NAME: f64 = ...;` (or u32, u64) of the solvers becomes a function that reads the environment once. CN_CONSTANT="solver/stages.rs:LEAST_SHARE=30"
sets one constant. CN_CONSTANTS_READ names a file into which each constant that is used writes a line. Constants in array lengths, patterns and
traits stay constants.
"""

import pathlib
import re
import sys

FOLDERS = ("adhesion", "friction", "solver", "methods", "contact", "visco", "progress", "operator")
STAY = {"methods/fields.rs:ROUND_OFF", "solver/quantities/deepest.rs:FIRST_DEPTH", "solver/quantities/deepest.rs:DEPTH_RATIO", "solver/by_creepages.rs:FAR"}
DECLARED = re.compile(r"^(\s*)((?:pub(?:\([a-z: ]*\))? )?)const ([A-Z_0-9]+): (f64|u32|u64) = ([^;]+);")
USED = re.compile(r"\buse [^;]+;")
NAME = re.compile(r"((?:\b\w+::)*)\b([A-Z_][A-Z_0-9]+)\b")
READ = """
pub mod adjustable {
    pub fn get(key: &str, value: f64) -> f64 {
        if let Ok(path) = std::env::var("CN_CONSTANTS_READ") {
            use std::io::Write;
            let file = std::fs::OpenOptions::new().append(true).create(true).open(path);
            let _ = file.and_then(|mut file| writeln!(file, "{key} {value:e}"));
        }
        let set = std::env::var("CN_CONSTANT").unwrap_or_default();
        set.split_once('=').filter(|(name, _)| *name == key).map_or(value, |(_, text)| text.parse().unwrap())
    }
}
"""


def declared(root):
    """The constants that are made adjustable: {file: {name: whether it is public}}."""
    found = {}
    for path in sorted(root.rglob("*.rs")):
        name = path.relative_to(root).as_posix()
        if name.split("/")[0] in FOLDERS:
            for line in path.read_text().splitlines():
                match = DECLARED.match(line)
                if match and f"{name}:{match[3]}" not in STAY:
                    found.setdefault(path, {})[match[3]] = bool(match[2])
    return found


def rewritten(text, name, own, public):
    """The text of a file with functions in the place of its constants `own`, and calls in the place of their uses and those of `public` ones."""
    imports = [match.span() for match in USED.finditer(text)]
    imported = {word for a, b in imports for word in re.findall(r"\b[A-Z_0-9]{2,}\b", text[a:b])} & public

    def called(match):
        path, word, at = match[1], match[2], match.start(2)
        start = text.rfind("\n", 0, at) + 1
        line = text[start : text.find("\n", at)]
        declares = DECLARED.match(line)
        if any(a <= at < b for a, b in imports) or line.lstrip().startswith("//") or declares and declares[3] == word:
            return match[0]
        is_meant = word in public and not path.startswith(("f64", "f32", "u64", "usize", "Self", "T::")) if path else word in own or word in imported
        return match[0] + "()" if is_meant else match[0]

    def function(line):
        match = DECLARED.match(line)
        if not match or match[3] not in own:
            return line
        indent, public_word, word, kind, value = match.groups()
        get = f'crate::adjustable::get("{name}:{word}", ({value}) as f64) as {kind}'
        body = f"static V: std::sync::LazyLock<{kind}> = std::sync::LazyLock::new(|| {get}); *V"
        return f"{indent}#[allow(non_snake_case)] {public_word}fn {word}() -> {kind} {{ {body} }}" + line[match.end() :]

    text = "\n".join(function(line) for line in NAME.sub(called, text).split("\n"))
    return re.sub(r"\{[A-Z_]+\(\)(:[^}]*)?\}", "it", text)  # in messages


def main():
    """Rewrites the files of the copy."""
    root = pathlib.Path(sys.argv[1]) / "src"
    constants = declared(root)
    public = {name for names in constants.values() for name, is_public in names.items() if is_public}
    for path in root.rglob("*.rs"):
        text = path.read_text()
        path.write_text(rewritten(text, path.relative_to(root).as_posix(), constants.get(path, {}), public))
    with open(root / "lib.rs", "a") as lib:
        lib.write(READ)
    print(sum(map(len, constants.values())), "constants")


main()
