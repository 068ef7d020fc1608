//! What all targets share: opening a file, and what must hold whatever was in it.

pub use serde_json::{Value, json};
use sinew::import::{File, Imported, Options, Sampling, open};

/// Opens files; panics where the answer is neither a sound sequence nor a sentence.
pub fn opens_or_says_why(files: &[(&str, &[u8])]) {
    let files: Vec<File> =
        files.iter().map(|(name, bytes)| File { name: (*name).into(), bytes: bytes.to_vec() }).collect();
    // A pose at every key: a damaged time does not make thousands of them.
    let options = Options { sampling: Sampling::Keys, look: true, ..Options::default() };
    match open(&files, &options) {
        Ok(imported) => check(&imported),
        Err(error) => assert!(error.0.len() > 10 && !error.0.contains('\n'), "not a sentence: {error}"),
    }
}

fn check(imported: &Imported) {
    let sequence = &imported.sequence;
    let vertices = sequence.reference().len();
    assert!(sequence.faces().iter().flatten().all(|&v| (v as usize) < vertices));
    let poses = sequence.poses().iter().map(|pose| pose.positions.as_slice());
    for positions in [sequence.reference()].into_iter().chain(poses) {
        assert_eq!(positions.len(), vertices);
        assert!(positions.iter().all(|p| p.is_finite()));
    }
    assert!(sequence.diagonal().is_finite());
    if let Some(look) = &imported.look {
        assert!(look.fits(vertices, sequence.faces().len()));
    }
}

/// A GLB of a document and its buffer.
pub fn glb(document: &Value, bytes: &[u8]) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut glb = b"glTF".to_vec();
    glb.extend(2_u32.to_le_bytes());
    glb.extend(0_u32.to_le_bytes());
    for (kind, chunk) in [(b"JSON", text.as_slice()), (b"BIN\0", bytes)] {
        glb.extend((chunk.len() as u32).to_le_bytes());
        glb.extend(kind);
        glb.extend(chunk);
    }
    glb
}
