use std::time::Instant;
use supel::*;
fn main() {
    faer::set_global_parallelism(faer::Par::Seq);
    let args: Vec<String> = std::env::args().collect();
    let job = job::Job::read(std::path::Path::new(&args[1])).unwrap();
    let t = Instant::now();
    fn cpu() -> f64 {
        let s = std::fs::read_to_string("/proc/self/stat").unwrap();
        let f: Vec<&str> = s.rsplit(')').next().unwrap().split_whitespace().collect();
        (f[11].parse::<f64>().unwrap() + f[12].parse::<f64>().unwrap()) / 100.0
    }
    let lap = |s: &str| println!("{:8.3} cpu {:8.2} {s}", t.elapsed().as_secs_f64(), cpu());
    let input = input::read(&job.model).unwrap_or_else(|e| panic!("{e}"));
    lap("read");
    let model = model::Model::new(input).unwrap_or_else(|e| panic!("{e}"));
    println!("{:?} {:?}", model.findings, model.precision);
    lap("model");
    let p = partition::Partition::new(&model, &job.interfaces).unwrap_or_else(|e| panic!("{e}"));
    lap("partition");
    let rigid = match rigid::from_coordinates(&p).unwrap_or_else(|e| panic!("{e}")) {
        Some(r) => r,
        None => rigid::from_matrices(&p).unwrap_or_else(|e| panic!("{e}")).0,
    };
    println!("{} {:?} {:?}", rigid.count(), rigid.source, rigid.energy);
    lap("rigid");
    let rank = rigid::interface_rank(&p, &rigid).unwrap_or_else(|e| panic!("{e}"));
    println!("{rank:?}");
    let (k_ii, m_ii) = (p.internal_stiffness(), p.internal_mass());
    let pencil = factor::Pencil {
        stiffness: &k_ii,
        mass: &m_ii,
    };
    let an = factor::Analysis::new(pencil).unwrap();
    println!(
        "nnz {:.3e} flops {:.3e} bytes {:.3e}",
        an.nnz_factor,
        an.flops,
        an.factor_bytes() as f64
    );
    lap("analysis");
    let f = factor::Cholesky::new(&an, pencil, 0.0, &|i| p.name_of(i)).unwrap_or_else(|e| panic!("{e}"));
    lap("factor");
    let c = basis::constraint_modes(&p, &f, &rigid);
    println!("raw {:.2e} corrected {:?}", c.raw_rigid_error, c.rigid_error);
    lap("constraint");
    {
        use factor::SolveOperator;
        for w in [1usize, 4, 8, 16, 32] {
            let mut b = faer::Mat::<f64>::from_fn(p.n_internal, w, |i, j| ((i * 7 + j) % 13) as f64);
            let t0 = Instant::now();
            let c0 = cpu();
            for _ in 0..4 {
                f.solve_in_place(b.as_mut());
            }
            println!(
                "solve {w}: {:.1} ms/rhs cpu {:.1}",
                t0.elapsed().as_secs_f64() * 1e3 / w as f64 / 4.0,
                (cpu() - c0) * 1e3 / w as f64 / 4.0
            );
        }
        let x = faer::Mat::<f64>::from_fn(p.n_dofs(), 8, |i, j| ((i * 7 + j) % 13) as f64);
        let mut y = x.clone();
        for mat in [&p.stiffness, &p.mass] {
            let t0 = Instant::now();
            sparse::multiply(mat, x.as_ref(), y.as_mut());
            println!("product {}: {:.1} ms", mat.nnz(), t0.elapsed().as_secs_f64() * 1e3);
        }
        let v = faer::Mat::<f64>::from_fn(p.n_dofs(), 150, |i, j| ((i * 7 + j) % 13) as f64);
        let t0 = Instant::now();
        let c = dense::gram(v.as_ref(), x.as_ref());
        println!("gram: {:.1} ms", t0.elapsed().as_secs_f64() * 1e3);
        let t0 = Instant::now();
        dense::add_product(y.as_mut(), 1.0, v.as_ref(), c.as_ref());
        println!("add: {:.1} ms", t0.elapsed().as_secs_f64() * 1e3);
        let c = dense::gram(v.as_ref(), v.as_ref());
        let t0 = Instant::now();
        let _ = dense::symmetric_eigen(c.as_ref());
        println!("eigen 150: {:.1} ms", t0.elapsed().as_secs_f64() * 1e3);
    }
    let op = modes::FreeAtZero::new(&f, &p.stiffness, c.modes.as_ref(), c.stiffness.as_ref(), &rigid).unwrap();
    let prob = modes::ModalProblem {
        stiffness: &p.stiffness,
        mass: &p.mass,
        rigid: Some(&rigid),
        precision: p.precision,
    };
    let m = modes::elastic_modes(
        prob,
        &op,
        modes::ModeRequest {
            wanted: modes::Wanted::Count(50),
            eigensolver: job::Eigensolver::Lanczos,
            seed: 1,
        },
    )
    .unwrap();
    lap("modes");
    println!("{:?}", m.work);
    for (l, e) in m.lambda.iter().zip(&m.errors).take(8) {
        println!("{:.12e} {:?}", (l * p.scaling.eigenvalue_unit()), e);
    }
    println!(
        "worst be {:.2e}",
        m.errors.iter().map(|e| e.backward).fold(0.0, f64::max)
    );
    println!("orth {:?}", modes::mass_orthogonality(&p.mass, m.shapes.as_ref()));
    let n = factor::count_below(&p, &an, m.shift_above(0.5)).unwrap_or_else(|e| panic!("{e}"));
    println!("{n:?} found {}", m.count() + rigid.count());
    lap("count");
}
