//! Every file of the corpus that may hold matrices or a mesh: read, or refused by its reason. `docs/corpus.csv` has the table.

use std::path::{Path, PathBuf};

use supel::error::Error;
use supel::input::{Allowance, MeshInput, SingleMatrix};

/// Files whose packing and endings say that they may hold a matrix.
const MATRICES: [&str; 17] = [
    "mtx", "rsa", "rb", "tri", "op4", "op2", "full", "pch", "pch1", "asm", "mat", "h5ad", "h5", "sti", "mas", "bdf",
    "npz",
];
/// And those of meshes.
const MESHES: [&str; 14] =
    ["inp", "msh", "frd", "vtk", "vtu", "med", "rmed", "hmf", "xdmf", "h5m", "e", "exo", "cgns", "hdf"];
/// Larger files are looked at where the table is made, and left out where it is compared.
const LARGE: u64 = 1 << 20;

const TABLE: &str = "docs/corpus.csv";
const HEAD: [&str; 6] = ["file", "holds", "format", "rows or nodes", "nonzeros or cells", "verdict"];

type Row = [String; 6];

/// The ending of a name, without that of its packing.
fn ending(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let plain = name.strip_suffix(".gz").unwrap_or(&name);
    plain.rsplit_once('.').map_or(String::new(), |(_, ending)| ending.to_owned())
}

fn files_below(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() { files_below(&path, found) } else { found.push(path) }
    }
}

/// What is wrong, without the folder of the corpus.
fn verdict(error: &Error, corpus: &Path) -> String {
    let folder = format!("{}/", corpus.display());
    format!("{}: {}", error.code(), error.to_string().replace(&folder, ""))
}

/// The rows of the matrices of a file: one, or one for each where there are several.
fn matrices(corpus: &Path, file: &Path, rows: &mut Vec<Row>) {
    let shown = file.strip_prefix(corpus).expect("a file of the corpus").display().to_string();
    let read = |member: Option<&str>| {
        let file = member.map_or_else(|| file.to_owned(), |name| PathBuf::from(format!("{}:{name}", file.display())));
        SingleMatrix { file, layout: None, dofs: None }.read(&Allowance::of(None))
    };
    let row = |shown: String, outcome: Result<_, Error>| match outcome {
        Ok(supel::input::ReadSingle { input, layout, .. }) => {
            let (n, nonzeros) = (input.matrix.rows().to_string(), input.matrix.nnz().to_string());
            [shown, "matrix".into(), layout.name(), n, nonzeros, "read".into()]
        }
        Err(error) => [shown, "matrix".into(), String::new(), String::new(), String::new(), verdict(&error, corpus)],
    };
    match read(None) {
        Err(Error::MatrixAmbiguous { matrices, .. }) => {
            rows.extend(matrices.iter().map(|name| row(format!("{shown}:{name}"), read(Some(name)))));
        }
        outcome => rows.push(row(shown, outcome)),
    }
}

fn mesh(corpus: &Path, file: &Path) -> Row {
    let shown = file.strip_prefix(corpus).expect("a file of the corpus").display().to_string();
    match MeshInput::read(file, &Allowance::of(None)) {
        Ok(mesh) => {
            let cells = mesh.unread.as_ref().map_or_else(|| mesh.n_cells().to_string(), |_| String::new());
            let verdict =
                mesh.unread.map_or("read".to_owned(), |what| format!("nodes and groups read, no cells: {what}"));
            [shown, "mesh".into(), ending(file), mesh.nodes.labels.len().to_string(), cells, verdict]
        }
        Err(error) => [shown, "mesh".into(), ending(file), String::new(), String::new(), verdict(&error, corpus)],
    }
}

fn rows_of(corpus: &Path, file: &Path) -> Vec<Row> {
    let mut rows = Vec::new();
    let ending = ending(file);
    // Listings of programs are no files that anybody would give.
    let is_listing = file.to_string_lossy().contains(".f06") || file.to_string_lossy().contains(".out");
    if MESHES.contains(&ending.as_str()) {
        rows.push(mesh(corpus, file));
    } else if MATRICES.contains(&ending.as_str()) && !is_listing {
        matrices(corpus, file, &mut rows);
        // HDF5 without a matrix may be a mesh.
        let has_none = |row: &Row| row[5].starts_with("E-NO-MATRIX") || row[5].starts_with("E-HDF5-NO-MATRIX");
        if ending == "h5" && rows.iter().any(has_none) {
            let mesh = mesh(corpus, file);
            if !mesh[3].is_empty() {
                rows = vec![mesh];
            }
        }
    }
    rows
}

fn as_csv(rows: &[Row]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(HEAD).expect("written");
    rows.iter().for_each(|row| writer.write_record(row).expect("written"));
    String::from_utf8(writer.into_inner().expect("written")).expect("UTF-8")
}

/// With `SUPEL_UPDATE_DOCS` the table is made anew. A file that is refused names itself.
#[test]
fn every_file_of_the_corpus_is_read_or_refused_as_the_table_says() {
    let Some(pairs) = supel_testing::corpus::corpus() else { return };
    let corpus = pairs.parent().expect("the corpus").canonicalize().expect("a folder");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(TABLE);
    let is_made = std::env::var_os("SUPEL_UPDATE_DOCS").is_some();
    let mut files = Vec::new();
    files_below(&corpus, &mut files);
    files.retain(|file| is_made || std::fs::metadata(file).is_ok_and(|facts| facts.len() < LARGE));
    let rows: Vec<Row> = files.iter().flat_map(|file| rows_of(&corpus, file)).collect();
    for [file, .., verdict] in &rows {
        let name = file.rsplit('/').next().unwrap_or_default().split(':').next().unwrap_or_default();
        assert!(!verdict.starts_with("E-") || verdict.contains(name), "{file}: {verdict}");
    }
    if is_made {
        std::fs::write(&path, as_csv(&rows)).expect("written");
        return;
    }
    let table = std::fs::read_to_string(&path).expect("the table");
    let kept: Vec<Row> = csv::Reader::from_reader(table.as_bytes())
        .into_records()
        .map(|row| std::array::from_fn(|at| row.as_ref().expect("a row")[at].to_owned()))
        .collect();
    assert!(rows.len() > 100, "{}", rows.len());
    for row in &rows {
        let of_table = kept.iter().find(|other| other[0] == row[0]);
        assert_eq!(of_table, Some(row), "SUPEL_UPDATE_DOCS=1 makes {TABLE} anew");
    }
}
