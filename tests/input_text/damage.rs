//! Files cut short or with flipped bits: an error or a matrix, never a panic.

use proptest::prelude::*;

use crate::{Folder, gzip, job, mtx, read_text};

fn small() -> String {
    mtx("symmetric", 3, &[(1, 1, 2.5), (2, 1, -1.25e3), (2, 2, 4.0), (3, 3, 1e-7)])
}

#[test]
fn a_matrix_cut_at_every_byte() {
    let text = small();
    for end in 0..text.len() {
        let is_read = read_text(&text[..end]).is_ok();
        // The last entry stays an entry while one digit of its value is left.
        assert!(!is_read || end > text.len() - "1e-7\n".len(), "read {:?}", &text[..end]);
    }
    assert!(read_text(&text).is_ok());
}

#[test]
fn a_gzipped_matrix_cut_at_every_byte() {
    let bytes = gzip(small().as_bytes());
    for end in 0..bytes.len() {
        assert!(read_text(&bytes[..end]).is_err(), "{end} of {} bytes", bytes.len());
    }
    assert!(read_text(&bytes).is_ok());
}

#[test]
fn tables_cut_at_every_byte() {
    let folder = Folder::new();
    let matrix = folder.write("k.mtx", mtx("symmetric", 3, &[(1, 1, 1.0)]));
    let (map, table) = ("node,dof\n1,1\n1,2\n1,3\n", "node,x,y,z\n1,0.5,0,1e3\n");
    let mut model = job(&matrix, &matrix);
    for end in 0..map.len() {
        model.dofs = Some(folder.write("map.csv", &map[..end]));
        // Three rows are there once the last digit is.
        assert_eq!(supel::input::read(&model).is_ok(), end >= map.len() - 1, "{:?}", &map[..end]);
    }
    model.dofs = None;
    for end in 0..table.len() {
        model.nodes = Some(folder.write("nodes.csv", &table[..end]));
        let is_read = supel::input::read(&model).is_ok();
        assert!(!is_read || end > table.len() - "1e3\n".len(), "{:?}", &table[..end]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn flipped_bytes_never_panic(
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        zipped: bool,
    ) {
        let mut bytes = if zipped { gzip(small().as_bytes()) } else { small().into_bytes() };
        for (index, byte) in flips {
            let at = index.index(bytes.len());
            bytes[at] = byte;
        }
        if let Ok(input) = read_text(&bytes) {
            prop_assert!(input.stiffness.matrix.data().iter().all(|value| value.is_finite()));
        }
    }

    #[test]
    fn any_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let folder = Folder::new();
        let matrix = folder.write("k.mtx", mtx("symmetric", 3, &[(1, 1, 1.0)]));
        let noise = folder.write("noise", &bytes);
        let mut model = job(&matrix, &matrix);
        model.dofs = Some(noise.clone());
        let _ = supel::input::read(&model);
        model.dofs = None;
        model.nodes = Some(noise.clone());
        let _ = supel::input::read(&model);
        let _ = supel::input::read(&job(&noise, &matrix));
    }
}
