//! The data of picture.py, as comma-separated values.

use std::fs::File;
use std::io::{BufWriter, Result, Write};
use std::path::Path;

use contact_normal::methods::multigrid::SmootherKind::{GaussSeidel, Jacobi, RedBlack};
use local_fourier_analysis::Analysis;

fn create(folder: &Path, name: &str, header: &str) -> Result<BufWriter<File>> {
    let mut file = BufWriter::new(File::create(folder.join(name))?);
    writeln!(file, "{header}")?;
    Ok(file)
}

fn write(folder: &Path, name: &str, header: &str, table: &[[f64; 6]]) -> Result<()> {
    let mut file = create(folder, name, header)?;
    for row in table {
        writeln!(file, "{}", row.map(|value| value.to_string()).join(","))?;
    }
    file.flush()
}

/// Factors of Gauss-Seidel over the relaxation.
pub fn write_relaxation(folder: &Path, table: &[[f64; 6]]) -> Result<()> {
    write(folder, "relaxation.csv", "m,omega,two_grids,three_grids,measured,table_1", table)
}

/// Smoothing factors over the elements across.
pub fn write_sizes(folder: &Path, table: &[[f64; 6]]) -> Result<()> {
    write(folder, "sizes.csv", "across,gauss_seidel,red_black,jacobi,fft,two_grids", table)
}

/// The symbol, and the amplification of each wave by a sweep: square elements, 32 x 32 across.
pub fn write_waves(folder: &Path) -> Result<()> {
    let analysis = Analysis::new(1.0, 1.0, [32, 32], 2).expect("a valid analysis");
    let [tx, ty] = analysis.frequencies();
    let symbol = analysis.symbol();
    let left =
        [(GaussSeidel, 0.8), (RedBlack, 0.8), (Jacobi, 0.8)].map(|(kind, omega)| analysis.amplification(kind, omega));
    let mut file = create(folder, "waves.csv", "tx,ty,symbol,gauss_seidel,red_black,jacobi")?;
    for i in 0..symbol.len() {
        let (x, y) = (tx[i % tx.len()], ty[i / tx.len()]);
        writeln!(file, "{x},{y},{},{},{},{}", symbol[i], left[0][i], left[1][i], left[2][i])?;
    }
    file.flush()
}
