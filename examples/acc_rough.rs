#[path = "../benches/performance/case.rs"]
#[allow(dead_code)]
mod case;
use contact_normal::solver::*;
use contact_normal::scene::*;
fn main() {
    let o = Options { tolerance: 1e-8, estimates: true, ..Options::default() };
    let mut pairs: Vec<(case::Case, case::Case)> = [64, 128, 256, 512].map(|m| (case::rough(m), case::rough(if m == 512 { 2048 } else { 4 * m }))).into_iter().collect();
    for name in ["y0_10kN", "y4_82kN", "y10_10kN"] {
        pairs.extend([1, 2].map(|r| (case::wheel_rail(name, r), case::wheel_rail(name, 4 * r))));
    }
    for (coarse, fine) in &pairs {
        let l0 = solve(&fine.scene(), &o).unwrap().2.measures;
        for load in [Load::Approach(l0.approach), Load::Force(l0.force)] {
            let ex = l0;
            let (solver, _, rep) = solve(&coarse.scene_with(load), &o).unwrap();
            let st = solver.state(); let g = coarse.grid; let h = &coarse.h;
            let es = g.modulus(solver.influence().at(0, 0));
            let hmin = h.iter().cloned().fold(f64::INFINITY, f64::min);
            let (mut l, mut la, mut n) = (0.0, 0.0, 0.0);
            let pm = st.p.iter().sum::<f64>() / st.contact_count() as f64;
            let (mut lw, mut w) = (0.0, 0.0);
            for i in 0..h.len() {
                if !st.contact[i] { continue; }
                let (x, y) = (i % g.mx, i / g.mx);
                let mut t = 0.0;
                if x > 0 && x + 1 < g.mx { t += h[i-1] + h[i+1] - 2.0*h[i]; }
                if y > 0 && y + 1 < g.my { t += h[i-g.mx] + h[i+g.mx] - 2.0*h[i]; }
                l += t / 24.0; la += t.abs() / 24.0; n += 1.0;
                let q = 1.0 / (st.p[i] + 0.3 * pm); lw += q * t / 24.0; w += q;
            }
            let (l, la, lw) = (l / n, la / n, lw / w);
            let me = rep.measures; let pk = st.p.iter().position(|p| *p == me.max_pressure).unwrap(); let kap = (4.0 * st.p[pk] - st.p[pk-1] - st.p[pk+1] - st.p[pk-g.mx] - st.p[pk+g.mx]) / st.p[pk]; let ch = (0..h.len()-g.mx).filter(|&i| st.contact[i] != st.contact[i+1]).count() + (0..h.len()-g.mx).filter(|&i| st.contact[i] != st.contact[i+g.mx]).count(); let chord = 4.0 * n / ch as f64; print!("chord {chord:.1} kap {kap:.3} pmax true {:+.2e} est {:.2e} ", me.max_pressure / ex.max_pressure - 1.0, rep.error.max_pressure / me.max_pressure);
            let depth = me.approach - hmin;
            let stiff = 2.0 * es * (me.contact_area / std::f64::consts::PI).sqrt();
            let found = me.found(load); let exact = ex.found(load);
            let (s1, s2) = if matches!(load, Load::Force(_)) { (1.0, 1.0) } else { (1.5 * me.force / depth, stiff) };
            println!("{} {:?} n {} true {:+.3e} est {:.3e} | law {:.3e} abs {:.3e} w {:.3e} | stiff {:.3e}", coarse.name, load, n, found - exact, rep.error.force, l * s1, la * s1, lw * s1, l * s2);
        }
    }
}
