//! The description of the ABI, read from the header that cbindgen makes of src/ffi: constants, structs, callbacks. `generated.rs` makes the parts for
//! the other languages from it, and the programs that compare layouts.

/// A constant: its name without CONTACT_NORMAL_, its value, and its comment.
pub struct Constant {
    pub name: String,
    pub value: i64,
    pub comment: String,
}

/// A type of the header, as far as the languages differ in it.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    Int32,
    Int64,
    Double,
    /// A struct, by value.
    Struct(String),
    /// A function pointer: a callback of the header.
    Callback(String),
    /// `T *` or `const T *`. `None` for a T without a layout of its own (void, char, a handle).
    Pointer(Option<Box<Kind>>),
}

pub struct Member {
    pub name: String,
    pub kind: Kind,
    /// The length, if the member is an array in the struct.
    pub count: Option<usize>,
}

/// A struct and its members.
pub struct Struct {
    pub name: String,
    pub members: Vec<Member>,
}

impl Struct {
    /// The name without the prefix.
    pub fn short_name(&self) -> &str {
        &self.name["contact_normal_".len()..]
    }
}

/// A callback: its name, its result (`None`: void) and its arguments. An argument of type text is `Pointer(None)`, and is named "text".
pub struct Callback {
    pub name: String,
    pub result: Option<Kind>,
    pub arguments: Vec<(String, Kind)>,
}

pub struct Description {
    pub constants: Vec<Constant>,
    pub structs: Vec<Struct>,
    pub callbacks: Vec<Callback>,
}

impl Description {
    /// Reads a header in which each comment precedes its item.
    pub fn of(header: &str) -> Description {
        let mut found = Description { constants: Vec::new(), structs: Vec::new(), callbacks: Vec::new() };
        // Callbacks are read first, because members of structs have their types.
        let mut rest = header;
        while let Some((_, after)) = rest.split_once("\n/*\n") {
            let (comment, code) = after.split_once("*/\n").expect("the end of a comment");
            rest = code;
            if let Some(line) = code.strip_prefix("#define CONTACT_NORMAL_") {
                let (name, value) = line.lines().next().and_then(|line| line.split_once(' ')).expect("a value");
                let value = value.parse().expect("an integer");
                found.constants.push(Constant { name: name.into(), value, comment: one_line(comment) });
            } else if let Some(code) = code.strip_prefix("typedef struct ").filter(|code| is_definition(code)) {
                let (name, body) = code.split_once(" {\n").expect("a struct");
                let body = body.split_once(&format!("}} {name};")).expect("its end").0;
                let members = found.members(body);
                found.structs.push(Struct { name: name.into(), members });
            } else if code.starts_with("typedef ") && code.lines().next().is_some_and(|line| line.contains("(*")) {
                let callback = found.callback(code.split_once(';').expect("its end").0);
                found.callbacks.push(callback);
            }
        }
        assert!(
            found.constants.len() > 60 && found.structs.len() >= 20 && found.callbacks.len() == 3,
            "the header was not understood"
        );
        found
    }

    fn members(&self, body: &str) -> Vec<Member> {
        let without_comments: String =
            body.split("/*").map(|part| part.split_once("*/").map_or(part, |(_, code)| code)).collect();
        let declarations = without_comments.split(';').map(str::trim).filter(|declaration| !declaration.is_empty());
        declarations
            .map(|declaration| {
                let (declaration, count) = match declaration.strip_suffix(']').and_then(|text| text.split_once('[')) {
                    Some((before, count)) => (before, Some(count.parse().expect("a count"))),
                    None => (declaration, None),
                };
                let (name, kind) = self.declared(declaration);
                Member { name, kind, count }
            })
            .collect()
    }

    /// "const double *pressure": its name and its kind.
    fn declared(&self, declaration: &str) -> (String, Kind) {
        let start = declaration.rfind([' ', '*']).expect("a type") + 1;
        let (kind, name) = declaration.split_at(start);
        (name.into(), self.kind(kind.trim()))
    }

    fn kind(&self, text: &str) -> Kind {
        if let Some(to) = text.strip_suffix('*') {
            let to = to.trim().trim_start_matches("const ");
            let is_named =
                matches!(to, "double" | "int32_t" | "int64_t" | "contact_normal_status") || self.has_struct(to);
            return Kind::Pointer(is_named.then(|| Box::new(self.kind(to))));
        }
        let name = text.trim_start_matches("struct ");
        match name {
            "int32_t" | "contact_normal_status" => Kind::Int32,
            "int64_t" => Kind::Int64,
            "double" => Kind::Double,
            _ if self.has_struct(name) => Kind::Struct(name.into()),
            _ if self.callbacks.iter().any(|callback| callback.name == name) => Kind::Callback(name.into()),
            _ => panic!("what is {text}?"),
        }
    }

    fn has_struct(&self, name: &str) -> bool {
        let name = name.trim_start_matches("struct ");
        self.structs.iter().any(|known| known.name == name)
    }

    /// "typedef int32_t (*name)(int32_t mx, ...)".
    fn callback(&self, code: &str) -> Callback {
        let (result, rest) = code.trim_start_matches("typedef ").split_once(" (*").expect("a function pointer");
        let (name, arguments) = rest.split_once(")(").expect("arguments");
        let arguments = arguments.trim_end_matches(')').split(',');
        Callback {
            name: name.into(),
            result: (result != "void").then(|| self.kind(result)),
            arguments: arguments.map(|argument| self.declared(argument.trim())).collect(),
        }
    }

    /// The structs that have a KIND_ constant, and so an `_init`. Each with this constant, whose name ends in that of the struct.
    pub fn kinds(&self) -> Vec<(&Struct, &Constant)> {
        let of = |name: &str| self.structs.iter().find(|each| each.short_name() == name);
        let kinds = self.constants.iter().filter(|constant| constant.name.starts_with("KIND_"));
        kinds
            .map(|constant| {
                let name = constant.name["KIND_".len()..].to_lowercase();
                (of(&name).unwrap_or_else(|| panic!("no struct {name}")), constant)
            })
            .collect()
    }
}

fn is_definition(code: &str) -> bool {
    code.lines().next().is_some_and(|line| line.ends_with(" {"))
}

fn one_line(comment: &str) -> String {
    comment.split_whitespace().collect::<Vec<_>>().join(" ")
}

impl Constant {
    /// "0.1" or "0.2": the version at the end of the comment.
    pub fn since(&self) -> &str {
        let version = self.comment.rsplit_once("Since ").expect("a version").1;
        version.trim_end_matches('.')
    }
}
