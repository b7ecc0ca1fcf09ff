//! Splits large triangles, since a vertex is all that can hold a shadow.

use crate::bend::Bends;
use crate::contacts::cut_at_contacts;
use crate::exits::cut_at_exits;
use crate::facts::Facts;
use crate::junctions::joined;
use crate::passes::Monitor;
use crate::plan::{allowed, world};
use crate::progress::Stage;
use crate::proximity::Proximity;
use crate::receivers::Receivers;
use crate::sharing::halve_shared;
use crate::small::cubes;
use crate::split::{Edge, MOST_TRIANGLES, edge_place, edges, length};
use crate::towards::{most_triangles, towards, triangles};
use crate::world::World;
use crate::{Error, ProgressFn, settings};
use coeff_io::{Effect, Refine, Settings};
use rayon::prelude::*;
use scene::{Bounds, Mesh, Scene};
use std::borrow::Cow;
use std::ops::ControlFlow;

/// Triangles that a scene of few, large ones is split into at least.
pub(crate) const LEAST_TRIANGLES: f64 = 20_000.0;
/// Least size of a scene, metres: of smaller ones squares of the areas of small triangles are less than single precision holds.
const LEAST_SIZE: f32 = 1e-8;
/// Rounds of halving; each halves the longest edges, so that these reach 1/4096 of the first. Where slivers share vertices, now or in a later
/// round, twice as many.
const ROUNDS: usize = 12;
/// Rounds of halving where transfer bends: edges down to an eighth of the even ones are halved.
const BEND_ROUNDS: i32 = 3;
/// The same with those rounds in which only edges near small objects are halved.
const SMALL_ROUNDS: i32 = 8;
/// Shortest edge that is halved beside a small object, in its sizes.
const SMALL_PART: f32 = 1.0 / 16.0;
/// Sizes of objects that even edges are too long for, in those edges. What is smaller shades less than one picture element of most views.
const SMALL: [f32; 2] = [1.0 / 512.0, 0.5];

/// The scene with every edge at most as long as the settings say; borrowed where nothing is to be split.
///
/// [`Refine::Auto`] takes the edge that triangles would have if as many as the scene has (or 20,000 where it has fewer) lay evenly over
/// its surfaces, then looks where transfer bends between vertices, or bounced light where some is asked for, and halves those edges up to
/// three times; it leaves a scene alone in
/// which nothing casts a shadow or shadows are not asked for. Edges are split for what they are, wherever they occur, so neighbours stay joined, across meshes too;
/// an edge along which shorter ones end is cut there first.
/// The surface stays the same; vertices of a mesh keep their indices, new ones follow.
///
/// # Errors
/// [`Error`] as in [`crate::bake`], where the scene is too large or a setting out of range.
pub fn refine<'a>(scene: &'a Scene, settings: &Settings) -> Result<Cow<'a, Scene>, Error> {
    refine_watched(scene, settings, &|_| ControlFlow::Continue(()))
}

/// The scene as it is baked; an empty one is refused.
pub(crate) fn refined<'a>(
    scene: &'a Scene,
    settings: &Settings,
    progress: ProgressFn<'_>,
) -> Result<Cow<'a, Scene>, Error> {
    check_size(scene)?;
    refine_watched(scene, settings, progress)
}

/// Refuses scenes without triangles and those too small for single precision.
pub(crate) fn check_size(scene: &Scene) -> Result<(), Error> {
    if scene.meshes.iter().all(|m| m.triangles.is_empty()) {
        return Err(Error::EmptyScene { scene: scene.name.clone() });
    }
    let size = size(scene);
    if size > 0.0 && size < LEAST_SIZE {
        let (size, least) = (format!("{size:e}"), "1e-8");
        return Err(Error::TooSmall { scene: scene.name.clone(), size, least });
    }
    Ok(())
}

/// Largest extent of the vertices, metres; what is not finite does not count.
fn size(scene: &Scene) -> f32 {
    let positions = scene.meshes.iter().flat_map(|mesh| &mesh.positions).copied();
    Bounds::of(positions.filter(|p| p.is_finite())).map_or(0.0, |bounds| bounds.size().max_element())
}

/// [`refine`] that reports progress and can be cancelled.
///
/// # Errors
/// As [`refine`], and [`Error::Cancelled`].
pub fn refine_watched<'a>(
    scene: &'a Scene,
    settings: &Settings,
    progress: ProgressFn<'_>,
) -> Result<Cow<'a, Scene>, Error> {
    Halved::new(scene, settings, progress)?.cut(settings, progress)
}

/// A scene with its edges halved, and not yet cut where surfaces come out of bodies or from under covers.
pub(crate) struct Halved<'a> {
    scene: Cow<'a, Scene>,
    /// The surfaces, where more is to be cut, and the shortest edge that is halved where transfer bends.
    rest: Option<(World<'a>, f32)>,
}

impl<'a> Halved<'a> {
    /// Halves the edges of a scene that is not empty.
    pub(crate) fn new(scene: &'a Scene, settings: &Settings, progress: ProgressFn<'_>) -> Result<Self, Error> {
        settings::check(settings)?;
        let done = |scene| Ok(Self { scene, rest: None });
        match settings.refine {
            Refine::Off => return done(Cow::Borrowed(scene)),
            Refine::Edge(longest) => return done(evenly(joined(scene, longest), longest)?),
            Refine::Auto if !allowed(settings, Effect::Visibility) => return done(Cow::Borrowed(scene)),
            Refine::Auto => (),
        }
        let monitor = Monitor::new(progress);
        monitor.begin(Stage::Preparation, 1);
        monitor.check()?;
        let facts = Facts::of_materials(scene, settings, false);
        let world = world(scene, &facts, settings)?;
        if !has_shadows(scene, &world) {
            return done(Cow::Borrowed(scene));
        }
        let longest = even_edge(scene);
        let small = cubes(scene, &|m| facts.materials[m].blocks, SMALL.map(|part| part * longest));
        let shortest = longest * 0.5f32.powi(BEND_ROUNDS);
        let joined = joined(scene, shortest);
        let (refined, small) = towards(evenly(joined, longest)?, Proximity::new(small))?;
        let bends = Bends::new(&world, &refined, settings);
        let scene = at_bends(refined, longest, &small, bends, &monitor)?;
        Ok(Self { scene, rest: Some((world, shortest)) })
    }

    /// The scene so far.
    pub(crate) fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The scene with the rest of its cuts.
    pub(crate) fn cut(self, settings: &Settings, progress: ProgressFn<'_>) -> Result<Cow<'a, Scene>, Error> {
        let Some((world, shortest)) = self.rest else { return Ok(self.scene) };
        let monitor = Monitor::new(progress);
        let scene = cut_at_exits(self.scene, &world, settings, &monitor)?;
        cut_at_contacts(scene, &world, (settings, shortest), &monitor)
    }
}

/// Whether anything in the scene can cast a shadow on a receiver.
fn has_shadows(scene: &Scene, world: &World<'_>) -> bool {
    Receivers::of(scene).list.par_iter().any(|receiver| world.can_shadow(receiver))
}

/// Longest edge of triangles spread evenly over all surfaces: half a square of that diagonal has the mean area; twice
/// the length leaves alone what is about even.
fn even_edge(scene: &Scene) -> f32 {
    let (mut area, mut count) = (0.0, 0.0);
    for mesh in &scene.meshes {
        area += (0..mesh.triangles.len()).map(|t| mesh.area(t)).sum::<f64>();
        count += mesh.triangles.len() as f64;
    }
    (2.0 * (4.0 * area / f64::max(count, LEAST_TRIANGLES)).sqrt()) as f32
}

/// Splits edges by their length alone.
fn evenly(mut scene: Cow<'_, Scene>, longest: f32) -> Result<Cow<'_, Scene>, Error> {
    let is_longer = |mesh: &Mesh, edge: Edge| length(mesh, edge) > longest;
    let has_longer = |mesh: &Mesh| mesh.triangles.iter().any(|t| edges(t).iter().any(|&edge| is_longer(mesh, edge)));
    if !scene.meshes.iter().any(has_longer) {
        return Ok(scene);
    }
    let name = scene.name.clone();
    for mesh in &mut scene.to_mut().meshes {
        let (mut round, mut most) = (0, ROUNDS);
        while has_longer(mesh) {
            if round == most {
                return Err(too_fine(&name, mesh.triangles.len()));
            }
            if halve_shared(mesh, is_longer).is_shared {
                most = 2 * ROUNDS;
            }
            round += 1;
            check_count(&name, mesh)?;
        }
    }
    Ok(scene)
}

/// Halves the edges along which transfer bends, while they are longer than a part of the even ones or of small objects near them.
fn at_bends<'a>(
    mut scene: Cow<'a, Scene>,
    longest: f32,
    small: &Proximity,
    mut bends: Bends<'_>,
    monitor: &Monitor<'_>,
) -> Result<Cow<'a, Scene>, Error> {
    let most = most_triangles(&scene);
    let none = Proximity::default();
    for round in 0..if small.is_empty() { BEND_ROUNDS } else { SMALL_ROUNDS } {
        let shortest = if round < BEND_ROUNDS { longest * 0.5f32.powi(round + 1) } else { f32::INFINITY };
        let small = if triangles(&scene) > most { &none } else { small };
        let may_halve = |mesh: &Mesh, edge: Edge, new: bool| {
            let [a, b] = edge.map(|v| mesh.positions[v as usize]);
            let length = length(mesh, edge);
            length > shortest || new && small.may_halve(0.5 * (a + b), length, SMALL_PART)
        };
        let bent = bends.find(&scene, &may_halve, monitor)?;
        if bent.is_empty() {
            break;
        }
        let name = scene.name.clone();
        for (index, mesh) in scene.to_mut().meshes.iter_mut().enumerate() {
            let halved = halve_shared(mesh, |mesh, edge| bent.contains(&edge_place(mesh, edge)));
            bends.halved(index, halved.middles);
            check_count(&name, mesh)?;
        }
    }
    Ok(scene)
}

pub(crate) fn check_count(scene: &str, mesh: &Mesh) -> Result<(), Error> {
    if mesh.triangles.len() > MOST_TRIANGLES { Err(too_fine(scene, mesh.triangles.len())) } else { Ok(()) }
}

fn too_fine(scene: &str, count: usize) -> Error {
    let what = "triangles after splitting (allow longer edges)";
    Error::TooLarge { scene: scene.to_owned(), what, count, limit: MOST_TRIANGLES }
}
