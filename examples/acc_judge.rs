#[path = "../campaign/src/random.rs"]
#[allow(dead_code)]
mod random;
#[path = "accuracy/surfaces.rs"]
mod surfaces;
#[path = "accuracy/judge.rs"]
mod judge;
use contact_normal::solver::Stop;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let which: judge::Surfaces = if a[2] == "s" { surfaces::studied } else { surfaces::held_back };
    let n: u64 = a[3].parse().unwrap();
    match &a[1][..] {
        "t" => {
            let all = judge::searches(which, 0..n);
            let ok: Vec<_> = all.iter().filter(|s| s.stop == Stop::Converged).collect();
            let missed: Vec<_> = ok.iter().filter(|s| s.miss > 1.0).collect();
            println!("{} searches, {} OK, {} missed", all.len(), ok.len(), missed.len());
            for s in &missed { println!("  missed {} {} {:e} by {:.2} {:?}", s.family, s.by_force, s.target, s.miss, s.across); }
            for s in all.iter().filter(|s| s.stop != Stop::Converged) { println!("  {:?} {} {} {:e}: {}", s.stop, s.family, s.by_force, s.target, s.reason); }
            let mut r: Vec<f64> = ok.iter().filter_map(|s| s.cheapest.map(|c| s.elements as f64 / c as f64)).collect();
            r.sort_by(f64::total_cmp);
            println!("elements over cheapest: {} known; median {} 90% {} max {}", r.len(), r[r.len()/2], r[r.len()*9/10], r[r.len()-1]);
            let least = ok.iter().map(|s| if s.family.contains("wave") { s.across.0 } else { s.across.0.min(s.across.1) }).min();
            println!("least across {:?}", least);
        }
        "p" => {
            let all = judge::prices(which, 0..n, 1024);
            let mut q: Vec<f64> = all.iter().filter(|p| p.seconds > 0.0).map(|p| p.price.seconds_one_thread / p.seconds).collect();
            q.sort_by(f64::total_cmp);
            println!("{} rows, {} paid; predicted/paid min {:.2} 5% {:.2} med {:.2} 95% {:.2} max {:.2}; within 1.5: {:.2}", all.len(), q.len(), q[0], q[q.len()/20], q[q.len()/2], q[q.len()*19/20], q[q.len()-1], q.iter().filter(|r| **r < 1.5 && **r > 1.0/1.5).count() as f64 / q.len() as f64);
            for p in &all { println!("{:20} {:5} {:.0e} {}x{} k {} cheapest {:?} pred {:.2e} paid {:.2e} err {:.1e} true {:.1e} {:?} list {:.3}", p.family, p.by_force, p.price.target, p.price.grid.mx, p.price.grid.my, p.doublings.0, p.doublings.1, p.price.seconds_one_thread, p.seconds, p.price.error, p.error, p.price.obstacle, p.list); }
        }
        _ => {
            for ((q, f), e) in judge::estimates(which, 0..n, &[64, 100, 128, 200, 256]) {
                println!("{:18} {:22} runs {:3} unknown {:.2} infinite trusted {} low {:.2} min {:.2} med {:.2} 95% {:.1}", judge::QUANTITIES[q], f, e.runs, e.unknown(), e.trusted_infinite, e.low(), e.quantile(0.0), e.quantile(0.5), e.quantile(0.95));
            }
        }
    }
}
