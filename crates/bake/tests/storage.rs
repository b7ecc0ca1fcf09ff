//! Where transfer is kept follows what the plan simulates, whether a plan was needed to know it or not.

mod support;

use coeff_io::{Effect, Effects, Sampler, Settings};
use support::{fixed, grey};

#[test]
fn storage_agrees_with_the_plan() {
    let mut found = [0, 0];
    let named = Effects::Only(vec![Effect::Visibility, Effect::Specular, Effect::Glossy]);
    for (metallic, effects) in [(0.0, Effects::Auto), (1.0, Effects::Auto), (0.0, named)] {
        let mut scene = grey("sphere-on-plane", 0.5);
        scene.materials.iter_mut().for_each(|m| (m.metallic, m.roughness) = (metallic, 0.3));
        let settings = Settings { effects, ..fixed(3, Sampler::OwenSobol, 32, 0) };
        let plan = bake::plan(&scene, &settings).expect("the scene can be baked");
        let glossy = plan.rows.iter().any(|row| row.effect == Effect::Glossy && row.simulate);
        let choice = bake::storage(&scene, &settings).expect("the scene can be baked");
        assert_eq!(choice.reason.contains("no reflection is simulated"), !glossy, "{metallic}: {}", choice.reason);
        found[usize::from(glossy)] += 1;
    }
    assert!(found.iter().all(|&count| count > 0), "can fail: both happen, {found:?}");
}
