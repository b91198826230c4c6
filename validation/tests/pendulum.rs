use validation::integrator::*;
use validation::pendulum::*;
#[test]
fn debug() {
    let folder = tempfile::tempdir().unwrap();
    let mut base = None;
    for (modes, h) in [(20, 1e-3), (60, 1e-3), (0, 1e-3), (120, 1e-3)] {
        let t = std::time::Instant::now();
        let s = swing(folder.path(), modes, &Scheme { step: h, n_steps: (2.0 / h) as usize, ..SCHEME });
        let s = match s {
            Ok(s) => s,
            Err(e) => {
                println!("{modes} {h} {e}");
                continue;
            }
        };
        let e = s.curves.column(6);
        let k = s.curves.column(3);
        let kmax = k.iter().copied().fold(0.0, f64::max);
        let err = e.iter().map(|x| (x - e[0]).abs()).fold(0.0, f64::max);
        println!(
            "{modes} {h}: {:?} {:.2} {:?}  kmax {kmax:e} energy err {:e} strain {:e}",
            s.effort,
            s.effort.mean(),
            t.elapsed(),
            err / kmax,
            s.curves.column(4).iter().copied().fold(0.0, f64::max)
        );
        for t in [0.0, 0.2, 0.4, 0.6] {
            println!("   {:?}", s.curves.at(t));
        }
        if modes == 20 && h == 1e-3 {
            base = Some(s.curves);
        } else if let Some(b) = &base {
            for c in 0..3 {
                println!("  {c} {:?}", b.misfit(c, (&s.curves, c), [0.0, 2.0]))
            }
        }
    }
}
