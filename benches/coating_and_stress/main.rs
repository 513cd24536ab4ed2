//! Times of subsurface stresses and of coatings: `cargo bench --bench coating_and_stress`.

mod stress;

fn main() {
    stress::report();
}
