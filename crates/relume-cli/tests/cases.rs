//! Files from practice through the whole program: the picture of one must be that of a plain file.

mod command;
mod model;

use command::{complaint, relume};
use model::{Shape, material, unlit};
use serde_json::json;
use std::path::Path;

const QUICK: [&str; 6] = ["--rays", "64", "--bounces", "1", "--bands", "3"];

fn run(folder: &Path, arguments: &[&str]) -> String {
    let output = relume(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", complaint(&output));
    complaint(&output)
}

/// What was said of a bake, and the linear picture under a light.
fn drawn(folder: &Path, scene: &str, light: &str) -> (String, Vec<[f32; 3]>) {
    let said = run(folder, &[&["bake", scene, "-o", "a.prt"][..], &QUICK].concat());
    run(
        folder,
        &[
            "render",
            "a.prt",
            "--probe",
            light,
            "--size",
            "96x72",
            "--backend",
            "cpu",
            "--background",
            "black",
            "-o",
            "a.exr",
        ],
    );
    (said, probe_io::read_picture(&folder.join("a.exr")).unwrap().2)
}

/// Mean difference over the mean.
fn off(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
    let apart: f32 = a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| (a - b).abs()).sum();
    apart / b.as_flattened().iter().sum::<f32>()
}

/// The share of the pixels that show a colour.
fn share(pixels: &[[f32; 3]], color: [f32; 3]) -> f32 {
    let alike = |p: &&[f32; 3]| p.iter().zip(color).all(|(a, b)| (a - b).abs() < 0.02);
    pixels.iter().filter(alike).count() as f32 / pixels.len() as f32
}

#[test]
fn pictures_of_cases_equal_those_of_plain_files() {
    let Some(data) = testkit::data_dir() else { return testkit::skip("cases") };
    let folder = tempfile::tempdir().unwrap();
    let picture =
        |name: &str| drawn(folder.path(), &data.join("cases").join(name).display().to_string(), "builtin:sky");
    for (control, names) in [
        (
            "reference/red-box.gltf",
            &["specular-glossiness/factor.gltf", "animation-target/no-node.gltf", "animation-target/pointer.gltf"][..],
        ),
        ("reference/red-cube-obj/a.obj", &["obj-bom/mtllib-first/a.obj", "obj-bom/in-the-mtl/a.obj", "mtl-tr-1/a.obj"]),
        ("far-from-origin/control-tower-origin.gltf", &["far-from-origin/tower-utm.gltf"]),
        ("skin-at-rest/control-body-below-armature.gltf", &["skin-at-rest/body-at-root.gltf"]),
    ] {
        let (_, expected) = picture(control);
        for name in names {
            let (said, pixels) = picture(name);
            assert!(off(&pixels, &expected) < 1e-3, "{name}: off by {}: {said}", off(&pixels, &expected));
        }
    }
    let (cube, body) = (picture("reference/red-cube-obj/a.obj").1, picture("obj-bom/vertex-first/a.obj").1);
    assert!(off(&body, &cube) > 0.02, "can fail: one cube is grey");
}

#[test]
fn inspect_counts_the_meshes_of_instances() {
    let Some(data) = testkit::data_dir() else { return testkit::skip("cases/gpu-instancing") };
    let folder = tempfile::tempdir().unwrap();
    for name in ["used", "required"] {
        let scene = data.join(format!("cases/gpu-instancing/{name}.gltf")).display().to_string();
        run(folder.path(), &["bake", &scene, "-o", "a.prt", "--rays", "16", "--bounces", "0", "--bands", "2"]);
        let seen = relume(folder.path(), &["inspect", "a.prt"]);
        let text = String::from_utf8_lossy(&seen.stdout).into_owned();
        assert!(text.contains(" 17 meshes"), "{name}: {text}");
    }
}

#[test]
fn unlit_boxes_show_their_colour_whatever_the_light() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let color = [0.8, 0.1, 0.1];
    let parts = |look| {
        let crate_ = Shape::cuboid([-0.5, 0.0, -0.5], [0.5, 1.0, 0.5]);
        let ground = ("Ground", Shape::ground(1.0), material([0.5; 3], json!({})));
        [ground, ("Crate", crate_, material(color, look))]
    };
    model::write(folder, "own.gltf", &parts(json!({ "extensions": unlit() })));
    let shared = testkit::data_dir().map(|data| data.join("cases/unlit/unlit-box.gltf").display().to_string());
    if shared.is_none() {
        testkit::skip("cases/unlit");
    }
    for scene in [Some("own.gltf".into()), shared].into_iter().flatten() {
        for light in ["builtin:constant:2", "builtin:constant:0.5"] {
            let (_, pixels) = drawn(folder, &scene, light);
            assert!(share(&pixels, color) > 0.03, "{scene} under {light}: {}", share(&pixels, color));
        }
    }
    model::write(folder, "own.gltf", &parts(json!({})));
    let (_, pixels) = drawn(folder, "own.gltf", "builtin:constant:2");
    assert!(share(&pixels, color) < 0.01, "can fail: a lit box is brighter but for its edges");
}
