//! The constants and prototypes of the Python package are those of the header.

use crate::generated::header;
use crate::python::python_in;
use crate::support::{run, scratch};

#[test]
fn constants_and_prototypes_are_those_of_the_header() {
    let header = header();
    let script = "
import contact_normal, contact_normal._library
for name, value in vars(contact_normal).items():
    if name.isupper() and isinstance(value, int) and not name.startswith('_'):
        print('#define CONTACT_NORMAL_' + name, value)
for name in contact_normal._library.PROTOTYPES:
    print('contact_normal_' + name + '(')
";
    let mut theirs: Vec<String> =
        run(python_in(&scratch("python_constants")).args(["-c", script])).lines().map(str::to_owned).collect();
    let mut ours: Vec<String> = header
        .lines()
        .filter(|line| line.starts_with("#define CONTACT_NORMAL_") && line.split(' ').count() == 3)
        .map(str::to_owned)
        .collect();
    // A prototype begins in the first column. Members and comments do not.
    ours.extend(
        header
            .lines()
            .filter(|line| line.contains("contact_normal_") && !line.starts_with([' ', '#', '*', '}', '/']))
            .filter(|line| !line.starts_with("typedef") && !line.starts_with("static inline"))
            .filter_map(|line| line.split_once('('))
            .map(|(before, _)| format!("{}(", before.rsplit([' ', '*']).next().expect("a name"))),
    );
    theirs.sort();
    ours.sort();
    let only = |these: &[String], those: &[String]| -> Vec<String> {
        these.iter().filter(|name| !those.contains(name)).cloned().collect()
    };
    assert_eq!((only(&theirs, &ours), only(&ours, &theirs)), (vec![], vec![]), "only in Python, only in the header");
}
