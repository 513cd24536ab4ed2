//! The time of one product A p by commit 9fd3772, the unit of some targets. The bench program of that commit measures it during the same run.

use std::collections::HashMap;
use std::process::Command;
use std::sync::Mutex;

static PRODUCTS: Mutex<Option<HashMap<(usize, String), f64>>> = Mutex::new(None);

/// Seconds of one product by commit 9fd3772 for a case; None without `CONTACT_NORMAL_OLD_PROGRAM`, which `make bench` sets.
pub fn product(case: &str, threads: usize) -> Option<f64> {
    let program = std::env::var("CONTACT_NORMAL_OLD_PROGRAM").ok()?;
    let mut products = PRODUCTS.lock().expect("the products");
    let products = products.get_or_insert_default();
    if !products.keys().any(|(of, _)| *of == threads) {
        products.extend(measured(&program, threads).into_iter().map(|(case, seconds)| ((threads, case), seconds)));
    }
    products.get(&(threads, case.to_owned())).copied()
}

/// Runs the bench program of another commit, and reads from its table of cold calls the cases and the seconds of their products.
fn measured(program: &str, threads: usize) -> Vec<(String, f64)> {
    let mut command = Command::new(program);
    command.args(["--bench", "--threads", &threads.to_string(), "cold"]);
    command.args(std::env::args().filter(|argument| ["--quick", "--processor"].contains(&&argument[..])));
    let out = command.output().expect("a process");
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let text = String::from_utf8_lossy(&out.stdout);
    // With several threads the program prints the table for one thread first.
    let wanted = format!("### Cold calls, {threads} thread(s)");
    let table = text.split(&wanted).nth(1).expect("its table of cold calls");
    let rows = table.lines().skip(1).take_while(|line| !line.starts_with("###"));
    rows.filter_map(|line| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        Some((cells.get(1)?.to_string(), seconds(cells.get(5)?)?))
    })
    .collect()
}

/// The seconds of a time that a table shows, as "1.234 ms".
fn seconds(shown: &str) -> Option<f64> {
    let (number, unit) = shown.split_once(' ')?;
    let scale = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6)].into_iter().find(|(name, _)| *name == unit)?.1;
    number.parse::<f64>().ok().map(|number| scale * number)
}

/// A time in products of commit 9fd3772, as text; "" if their time is not known.
pub fn in_products(time: f64, case: &str, threads: usize) -> String {
    product(case, threads).map_or(String::new(), |product| format!("{:.1}", time / product))
}
