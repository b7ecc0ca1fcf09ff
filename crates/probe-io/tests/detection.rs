//! The layout of a file is told by its shape and what it leaves empty; guesses are told, doubts are refused.

use probe_io::{Environment, Error, Layout, LoadOptions, write_exr};
use std::path::PathBuf;

/// Writes a picture under a name, loads it and removes it.
fn load(
    name: &str,
    width: usize,
    height: usize,
    light: impl Fn(usize, usize) -> f32,
) -> Result<(Layout, usize), Error> {
    let folder = std::env::temp_dir().join(format!("relume-detection-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path: PathBuf = folder.join(format!("{name}.exr"));
    let pixels: Vec<[f32; 3]> = (0..width * height).map(|i| [light(i % width, i / width); 3]).collect();
    write_exr(&path, width, height, &pixels).unwrap();
    let loaded = Environment::load(&path, &LoadOptions::strict());
    std::fs::remove_dir_all(&folder).unwrap();
    loaded.map(|(environment, warnings)| (environment.image.layout, warnings.len()))
}

fn disc(side: usize) -> impl Fn(usize, usize) -> f32 {
    move |x, y| {
        let at = |k: usize| (k as f32 + 0.5) / side as f32 * 2.0 - 1.0;
        if at(x).hypot(at(y)) < 1.0 { 1.0 } else { 0.0 }
    }
}

#[test]
fn shapes_and_empty_parts_tell_the_layout() {
    assert_eq!(load("plain", 32, 16, |_, _| 1.0).unwrap(), (Layout::Equirect, 0));
    assert_eq!(load("ball", 32, 32, disc(32)).unwrap(), (Layout::Angular, 0));
    let tall = |x: usize, y: usize| if x / 4 == 1 || y / 4 == 1 { 1.0 } else { 0.0 };
    assert_eq!(load("tall", 12, 16, tall).unwrap(), (Layout::VerticalCross, 0));
    assert_eq!(load("wide", 16, 12, tall).unwrap(), (Layout::HorizontalCross, 0));
    // A strip without the attribute is a guess, and says so.
    assert_eq!(load("strip", 4, 24, |_, _| 1.0).unwrap(), (Layout::Faces, 1));
    assert_eq!(load("my_exrcube", 4, 24, |_, _| 1.0).unwrap(), (Layout::ExrCube, 0));
    assert_eq!(load("odd_latlong", 30, 17, |_, _| 1.0).unwrap(), (Layout::Equirect, 1));
}

#[test]
fn shapes_and_empty_parts_tell_the_layout_can_fail() {
    for (name, width, height) in
        [("full-square", 32, 32), ("full-tall", 12, 16), ("full-wide", 16, 12), ("full-odd", 30, 17)]
    {
        let error = load(name, width, height, |_, _| 1.0).unwrap_err().to_string();
        assert!(error.contains("--layout") && error.contains(&format!("{width} x {height}")), "{error}");
    }
}

#[test]
fn a_stated_layout_must_fit_the_picture() {
    let path = std::env::temp_dir().join(format!("relume-stated-{}.exr", std::process::id()));
    write_exr(&path, 8, 4, &[[1.0; 3]; 32]).unwrap();
    for (name, layout) in Layout::NAMES {
        assert_eq!(name.parse::<Layout>().unwrap(), layout);
        let mut options = LoadOptions::strict();
        options.layout = Some(layout);
        let loaded = Environment::load(&path, &options);
        assert_eq!(loaded.is_ok(), layout == Layout::Equirect, "{name}");
    }
    std::fs::remove_file(&path).unwrap();
    assert!("cube".parse::<Layout>().unwrap_err().contains("exr-cube"));
}

#[test]
fn a_folder_with_a_missing_face_names_it() {
    let folder = std::env::temp_dir().join(format!("relume-faces-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for face in ["px", "nx", "py", "ny", "front"] {
        write_exr(&folder.join(format!("{face}.exr")), 2, 2, &[[1.0; 3]; 4]).unwrap();
    }
    let error = Environment::load(&folder, &LoadOptions::strict()).unwrap_err().to_string();
    assert!(error.contains("no face nz"), "{error}");
    write_exr(&folder.join("nz.exr"), 3, 3, &[[1.0; 3]; 9]).unwrap();
    let error = Environment::load(&folder, &LoadOptions::strict()).unwrap_err().to_string();
    assert!(error.contains("3 x 3 pixels, not 2 x 2"), "{error}");
    write_exr(&folder.join("nz.exr"), 2, 2, &[[1.0; 3]; 4]).unwrap();
    let (environment, _) = Environment::load(&folder, &LoadOptions::strict()).unwrap();
    assert_eq!((environment.image.width, environment.image.height), (2, 12));
    std::fs::remove_dir_all(&folder).unwrap();
}
