//! `relume uv` names what is wrong with light-map coordinates, and makes them.

mod command;

use command::{complaint, relume};

#[test]
fn a_scene_without_coordinates_is_told_and_can_be_unwrapped() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let output = relume(folder, &["uv", "builtin:cornell-box"]);
    let (told, error) = (String::from_utf8_lossy(&output.stdout), complaint(&output));
    assert_eq!(output.status.code(), Some(1), "{told}{error}");
    assert!(told.contains("there are no second texture coordinates (--unwrap shows what they could be)"), "{told}");
    assert!(error.contains("faults in the light-map coordinates"), "{error}");

    let arguments = ["uv", "builtin:cornell-box", "--unwrap", "--size", "256", "--layout", "sheet.png", "--json"];
    let output = relume(folder, &arguments);
    assert_eq!(output.status.code(), Some(0), "{}", complaint(&output));
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(value["faults"], serde_json::json!([]));
    let (width, height) = (value["atlas"]["width"].as_u64(), value["atlas"]["height"].as_u64());
    assert_eq!(width, Some(256));
    let picture = image::open(folder.join("sheet.png")).expect("a picture");
    assert_eq!((Some(u64::from(picture.width())), Some(u64::from(picture.height()))), (width, height));
    // The share of texels that are not background is about what is told to be filled, and the borders that charts graze.
    let filled = value["atlas"]["filled"].as_f64().expect("a share");
    let lit = picture.to_rgb8().pixels().filter(|p| p.0 != [24, 24, 28]).count() as f64;
    let share = lit / f64::from(picture.width() * picture.height());
    assert!(share > filled - 0.01 && share < filled + 0.15, "{share} of the picture, {filled} told");
}

#[test]
fn densities_that_cannot_be_are_refused_in_a_sentence() {
    let folder = tempfile::tempdir().expect("a folder");
    let tried = |option: &str| {
        let output = relume(folder.path(), &["uv", "builtin:teacup", "--unwrap", "-q", option]);
        (output.status.code(), complaint(&output))
    };
    for density in ["nan", "-1", "0", "1e9"] {
        let (code, error) = tried(&format!("--texels-per-metre={density}"));
        assert_eq!(code, Some(2), "{density}: {error}");
        assert!(error.contains("texels to a metre from"), "{density}: {error}");
    }
    let (code, error) = tried("--texels-per-metre=1000000");
    assert_eq!(code, Some(1), "{error}");
    assert!(error.contains("ask for fewer texels to a metre") && error.lines().count() == 1, "{error}");
    let (code, error) = tried("--size=16");
    assert_eq!(code, Some(1), "{error}");
    assert!(error.contains("charts do not fit a sheet of 16 texels") && error.lines().count() == 1, "{error}");
}
