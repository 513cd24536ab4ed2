#[path = "paper_tables/case.rs"]
#[allow(dead_code)]
mod case;
use contact_normal::{grid::Grid, influence::*, operator::*, scene::*, solver::*, threads::Threads};
use std::time::Instant;
pub fn rough(m: usize) -> Vec<f64> {
    let t = std::fs::read_to_string("../shared/data/rough/self_affine.txt").unwrap();
    let mut z = vec![0.0; m * m];
    let ks: Vec<(i64, i64, f64, f64)> = t
        .lines()
        .filter(|l| !l.starts_with('#'))
        .map(|l| {
            let v: Vec<f64> = l.split_whitespace().map(|x| x.parse().unwrap()).collect();
            (v[0] as i64, v[1] as i64, v[2], v[3])
        })
        .collect();
    let c: Vec<(f64, f64)> = (0..m)
        .map(|i| {
            let a = 2.0 * std::f64::consts::PI * i as f64 / m as f64;
            (a.cos(), a.sin())
        })
        .collect();
    let mut by: std::collections::BTreeMap<i64, Vec<(i64, f64, f64)>> = Default::default();
    for (ky, kx, re, im) in ks {
        by.entry(ky).or_default().push((kx, re, im));
    }
    for (ky, list) in by {
        let f: Vec<(f64, f64)> = (0..m)
            .map(|ix| {
                let mut s = (0.0, 0.0);
                for &(kx, re, im) in &list {
                    let (co, si) = c[((kx * ix as i64).rem_euclid(m as i64)) as usize];
                    s.0 += re * co - im * si;
                    s.1 += re * si + im * co;
                }
                s
            })
            .collect();
        for iy in 0..m {
            let (co, si) = c[((ky * iy as i64).rem_euclid(m as i64)) as usize];
            for ix in 0..m {
                z[iy * m + ix] += 2.0 * (f[ix].0 * co - f[ix].1 * si);
            }
        }
    }
    let mx = z.iter().copied().fold(f64::MIN, f64::max);
    z.iter().map(|v| mx - v).collect()
}
fn median(mut v: Vec<f64>) -> f64 {
    v.sort_by(f64::total_cmp);
    v[v.len() / 2]
}
fn run(name: &str, sc: &Scene, reps: usize, tol: f64) {
    let op = Toeplitz::<f64>::new(&sc.influence(), &sc.grid, &Threads::One).unwrap();
    let mut ws = op.workspace().unwrap();
    let p: Vec<f64> = (0..sc.grid.len()).map(|i| (i % 5) as f64).collect();
    let mut u = p.clone();
    op.apply(&p, &mut u, &mut ws);
    let (mut a, mut b) = (vec![], vec![]);
    let mut last = None;
    for _ in 0..reps {
        let t = Instant::now();
        op.apply(&p, &mut u, &mut ws);
        b.push(t.elapsed().as_secs_f64());
        let t = Instant::now();
        let r = solve(sc, &Options { tolerance: tol, ..Default::default() });
        a.push(t.elapsed().as_secs_f64());
        last = Some(r);
    }
    let (ta, tb) = (median(a), median(b));
    match last.unwrap() { Ok((_,s,r)) => println!("{name}: {:.3} ms = {:.1} products; {s:?} its {} products {} wu {:.1} res {:.1e} pen {:.1e} setup {:.2} F {:.6} contact {} MB {:.0} B/el {:.0}", ta*1e3, ta/tb, r.cycles, r.matrix_products, r.work_units, r.measures.certificate.residual, r.measures.certificate.penetration, r.setup_seconds/tb, r.measures.force, r.measures.contact_count, r.bytes as f64/1e6, r.bytes as f64/sc.grid.len() as f64), Err(e)=>println!("{name}: {e}") }
}
fn main() {
    let tol = std::env::args().nth(1).map(|x| x.parse().unwrap()).unwrap_or(1e-6);
    let most: usize = std::env::args().nth(2).map(|x| x.parse().unwrap()).unwrap_or(1024);
    for m in [16usize, 32, 64, 128, 256, 512, 1024, 2048] {
        if m <= most {
            let h = case::undeformed_distance(m);
            let reps = if m < 128 {
                201
            } else if m < 1024 {
                11
            } else {
                5
            };
            run(&format!("ellipse {m}"), &case::scene(m, &h), reps, tol);
            run(&format!("ellipse {m} force"), &Scene { load: Load::Force(81986.0), ..case::scene(m, &h) }, reps, tol);
        }
    }
    for m in [256usize, 512, 1024, 2048, 4096] {
        if m <= most {
            let g = Grid::new(m, m, 1.0 / m as f64, 1.0 / m as f64).unwrap();
            let h = rough(m);
            run(
                &format!("rough {m}"),
                &Scene::new(
                    g,
                    &h,
                    Bodies { shear_modulus: [0.5, f64::INFINITY], poisson_ratio: [0.0, 0.0] },
                    Load::Force(0.007),
                ),
                if m < 1024 { 11 } else { 3 },
                tol,
            );
        }
    }
    for f in std::fs::read_dir("../shared/data/wheel_rail").unwrap() {
        let f = f.unwrap().path();
        let t = std::fs::read_to_string(&f).unwrap();
        let mut it = t.lines().skip(3);
        let l: Vec<f64> = it.next().unwrap().split_whitespace().map(|x| x.parse().unwrap()).collect();
        let rows: Vec<Vec<f64>> = it.map(|l| l.split_whitespace().map(|x| x.parse().unwrap()).collect()).collect();
        let h: Vec<f64> = rows.iter().map(|r| r[0]).collect();
        let g = Grid::new(l[0] as usize, l[1] as usize, l[2], l[3]).unwrap();
        for load in [Load::Approach(l[4]), Load::Force(l[5])] {
            run(
                &format!("{:?} {load:?}", f.file_name().unwrap()),
                &Scene::new(g, &h, Bodies::same(l[6], l[7]), load),
                51,
                tol,
            );
        }
    }
}
