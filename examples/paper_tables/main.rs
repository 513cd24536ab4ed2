mod case;
use case::*;
use contact_normal::multigrid::SmootherKind;
use contact_normal::solver::Method;
fn main() {
    for m in [64, 128] { for w in [1.1, 0.8, 1.0] {
        let (s, r, f) = linear_system(m, Method::Multigrid, SmootherKind::GaussSeidel, w, 100);
        println!("T1 {m} {w} {s:?} {} {f:.6}", r.cycles);
    }
    let (s, r, f) = linear_system(m, Method::Norm, SmootherKind::GaussSeidel, 1.0, 1000);
    println!("T1 {m} CG {s:?} {} {f:.6}", r.cycles);
    }
    for m in [32, 64, 128, 256] {
        let row: Vec<String> = [(1,1),(1,0),(0,1)].iter().map(|&(a,b)| { let (s,r)=whole_problem(m, Method::Multigrid, a, b); format!("{} {s:?} {:.3}s", r.cycles, r.solve_seconds)}).collect();
        let (s,r)=whole_problem(m, Method::Norm, 1, 1);
        println!("T2 {m} {row:?} NORM {} ({}) {s:?} {:.3}", r.cycles, r.active_set_steps, r.solve_seconds);
        let row: Vec<String> = [(1,1),(1,0),(0,1)].iter().map(|&(a,b)| { let (s,r)=whole_problem(m, Method::FullMultigrid, a, b); format!("{} {s:?} {:.3}s", r.cycles, r.solve_seconds)}).collect();
        println!("T3 {m} {row:?}");
    }
    let (s, r) = whole_problem(1024, Method::Multigrid, 1, 1);
    println!("{s:?} {:?}", r);
}
