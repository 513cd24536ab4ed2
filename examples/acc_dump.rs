#[path = "../campaign/src/random.rs"]
mod random;
#[path = "accuracy/surfaces.rs"]
mod surfaces;
use contact_normal::solver::*;
fn main() {
    let seeds: u64 = std::env::args().nth(1).unwrap().parse().unwrap();
    for seed in 0..seeds {
        let mut r = random::Random::new(seed + 1000);
        for s in surfaces::studied(&mut r).into_iter().chain(surfaces::held_back(&mut r)) {
            for by_force in [false, true] {
                for m in [16usize, 32, 64, 128, 256, 512] {
                    if m * s.eighths.1 / 8 < 2 { continue; }
                    let grid = s.grid(m);
                    let h = s.distance(&grid);
                    let sc = s.scene(grid, &h, by_force);
                    let o = Options { tolerance: 1e-9, estimates: true, ..Options::default() };
                    let (solver, stop, rep) = solve(&sc, &o).unwrap();
                    let me = rep.measures;
                    let found = me.found(s.load(by_force));
                    let e = rep.error;
                    let mp = s.max_pressure.unwrap_or(f64::INFINITY);
                    let st = solver.state();
                    let (mut l, mut n) = (0.0, 0.0);
                    let pm = st.p.iter().sum::<f64>() / me.contact_count.max(1) as f64; let mut ws = [(0.0, 0.0); 3];
 let per = s.period.is_some();
                    let hmin = h.iter().cloned().fold(f64::INFINITY, f64::min);
                    for i in 0..h.len() {
                        if !st.contact[i] { continue; }
                        let (x, y) = (i % grid.mx, i / grid.mx);
                        let mut t = 0.0;
                        if x > 0 && x + 1 < grid.mx { t += h[i-1] + h[i+1] - 2.0*h[i]; }
                        else if per { t += h[(x+1)%grid.mx + y*grid.mx] + h[(x+grid.mx-1)%grid.mx+y*grid.mx] - 2.0*h[i]; }
                        if y > 0 && y + 1 < grid.my { t += h[i-grid.mx] + h[i+grid.mx] - 2.0*h[i]; }
                        if !t.is_finite() { t = 0.0; }
                        l += t / 24.0; n += 1.0;
                        for (k, c) in [0.1, 0.3, 1.0].iter().enumerate() { let q = 1.0 / (st.p[i] + c * pm); ws[k].0 += q * t / 24.0; ws[k].1 += q; }
                    }
                    let depth = me.approach - hmin;
  let stiff = 2.0 * (me.contact_area / std::f64::consts::PI).sqrt();
  let scale = if by_force { 1.0 / me.approach } else { (1.5 / depth).max(stiff / me.force) };
  let (mx, my) = (grid.mx, grid.my);
  let mut changes = 0;
  for i in 0..h.len() { let (x, y) = (i % mx, i / mx);
    if x + 1 < mx && st.contact[i] != st.contact[i+1] { changes += 1; }
    if y + 1 < my && st.contact[i] != st.contact[i+mx] { changes += 1; } }
  let chord = 4.0 * n / changes as f64;
  let pk = st.p.iter().position(|p| *p == me.max_pressure).unwrap();
  let (x, y) = (pk % mx, pk / mx);
  let mut kap = 0.0;
  if x > 0 && x + 1 < mx { kap += 2.0 * st.p[pk] - st.p[pk-1] - st.p[pk+1]; }
  if y > 0 && y + 1 < my { kap += 2.0 * st.p[pk] - st.p[pk-mx] - st.p[pk+mx]; }
  let kap = kap / me.max_pressure;
  let (law, laww, laws) = (scale * l / n, chord, kap);
  let wsv = ws.map(|(a, b)| scale * a / b);
println!("{},{},{},{},{:?},{:e},{:e},{:e},{:e},{:e},{:e},{:e},{:e},{},{:e},{:e},{:e},{:e},{:e},{:e},{:e}", s.family, seed, by_force, m, stop,
                        found / s.exact(by_force) - 1.0, e.force / found.abs(),
                        me.max_pressure / mp - 1.0, e.max_pressure / me.max_pressure,
                        me.contact_area / s.area - 1.0, e.contact_area / me.contact_area,
                        me.corrected_area / s.area - 1.0, e.corrected_area / me.contact_area, me.contact_count, rep.solve_seconds, law, laww, laws, wsv[0], wsv[1], wsv[2]);
                }
            }
        }
    }
}
