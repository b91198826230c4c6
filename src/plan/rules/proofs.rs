//! Proofs, paths of the program and files. K-25, K-26, K-29, K-30.

use crate::job::Certify;
use crate::plan::facts::Facts;
use crate::plan::rule::Decision;
use crate::plan::scene::Scene;

pub(in crate::plan) fn k25(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    match scene.job.certified() {
        Certify::None => Decision::left_out("counts and enclosures of modes: the job certifies nothing"),
        Certify::Count => Decision::left_out("enclosures of modes: the job asks for a count"),
        Certify::Full => Decision::kept("the job asks for every proof"),
    }
}

pub(in crate::plan) fn k26(_: &Scene<'_>, _: Option<&Facts>) -> Decision {
    Decision::kept("models of every size take the sparse path")
}

pub(in crate::plan) fn k29(_: &Scene<'_>, _: Option<&Facts>) -> Decision {
    Decision::left_out("sorting and merging of entries, where a file has them in order")
}

pub(in crate::plan) fn k30(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    let write = &scene.job.write;
    let unasked = [("the page", write.html.is_none()), ("JUnit", write.junit.is_none())];
    let names: Vec<&str> = unasked.into_iter().filter(|(_, is_unasked)| *is_unasked).map(|(name, _)| name).collect();
    match names.is_empty() {
        true => Decision::kept("the job asks for every output"),
        false => Decision::left_out(format!("{}: not asked for", names.join(" and "))),
    }
}
