//! probe
use contact_normal::multigrid::analysis::{Analysis, Symbol};
use contact_normal::multigrid::{CycleShape, SmootherKind};

#[test]
fn probe() {
    for (dx, dy) in [(1.0, 1.0), (1.0, 0.6), (0.6, 1.0)] {
        let symbol = Symbol::new(dx, dy, 1.0);
        let half = contact_normal::influence::HalfSpace::new(dx, dy, 1.0);
        let reach = 300i64;
        let window = |k: i64| {
            let x = (k as f64 / reach as f64).abs();
            if x <= 0.3 { 1.0 } else if x >= 1.0 { 0.0 } else { let s = (x - 0.3) / 0.7; 1.0 / (1.0 + (1.0 / (1.0 - s) - 1.0 / s).exp()) }
        };
        for (tx, ty) in [(3.0, 3.1), (1.0, -2.0), (-0.5, 0.7), (4.0, 1.0)] {
            let value = symbol.at(tx, ty);
            let (mut whole, mut re, mut im) = (0.0, 0.0, 0.0);
            for ky in -reach..=reach { for kx in -reach..=reach {
                let c = window(kx) * window(ky) * half.at(kx, ky);
                let (s, co) = (kx as f64 * tx + ky as f64 * ty).sin_cos();
                whole += c * co;
                if ky > 0 || ky == 0 && kx > 0 { re += c * co; im -= c * s; }
            } }
            println!("{dx} {dy} {tx} {ty}: {} {:.2e} {} {:.2e} {:.2e}", value.whole, value.whole - whole, value.before, value.before.re - re, value.before.im - im);
        }
    }
    let kinds = [SmootherKind::GaussSeidel, SmootherKind::RedBlack, SmootherKind::Jacobi, SmootherKind::Fft];
    for across in [16, 32, 64, 128] {
        for levels in [2, 3, 4] {
        let began = std::time::Instant::now();
        let analysis = Analysis::new(1.0, 0.6, [across, across], levels).unwrap();
        let f = |smoother, relaxation, pre, post| analysis.convergence_factor(&CycleShape { smoother, relaxation, pre_sweeps: pre, post_sweeps: post, coarsest: 4 });
        for kind in kinds {
            print!("{across} {levels} {kind:?}:");
            for omega in [0.5, 0.8, 1.0, 1.1] {
                print!("  {omega}: {:.3} {:.3} {:.3} {:.3}", analysis.smoothing_factor(kind, omega, 1), analysis.smoothing_factor(kind, omega, 2), f(kind, omega, 1, 1), f(kind, omega, 1, 0));
            }
            println!(" {:.2}", began.elapsed().as_secs_f64());
        }
        }
    }
}
