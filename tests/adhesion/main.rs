//! Adhesion: every number is compared with a closed form, a printed result, or conditions that are recomputed by the test's own product.

mod certificate;
mod cut_short;
mod dense;
mod dense_path;
mod ends;
mod friction;
mod hard_cases;
mod loop_of_loading;
mod maugis;
mod pairs;
mod parting;
mod prices;
mod pulls;
mod random;
mod refused;
mod sphere;
mod stability;
mod support;
mod westergaard;
