//! Which rays of a further step are worth tracing: those near the edges of what is seen.
//!
//! Where the directions of earlier steps around a new one all met the same, or were foreseen to, the new one is foreseen to meet it
//! too. Of such directions an even part is traced all the same, and what it finds otherwise counts for all of them: the foreseen
//! values are a control variate, so the sum over a step is unbiased but for the rounding of the part, while rays go to
//! where the error is.

/// Earlier directions around a new one.
const AROUND: usize = 8;
/// Of this many foreseen directions one is traced.
const PART: u32 = 3;
/// State of a direction that meets what passes a part of the light. Nothing is foreseen beside one: no sum of [`AROUND`] states that holds
/// it is 0 or [`AROUND`].
const PARTLY: u8 = 16;

/// For every direction after the first step of a set, those of earlier steps around it.
#[derive(Debug, Default)]
pub(crate) struct Surroundings {
    first: usize,
    lists: Vec<[u16; AROUND]>,
}

impl Surroundings {
    /// Of directions about +z that follow the cosine: their feet cover the unit disk evenly. `ends` are those of the steps.
    pub(crate) fn new(xs: &[f32], ys: &[f32], ends: &[usize]) -> Self {
        let first = ends.first().map_or(0, |&end| end.max(AROUND));
        let mut lists = Vec::with_capacity(xs.len() - first);
        for step in ends.windows(2) {
            let grid = Grid::new(&xs[..step[0]], &ys[..step[0]]);
            lists.extend((step[0]..step[1]).map(|j| grid.nearest([xs[j], ys[j]])));
        }
        Self { first, lists }
    }

    /// What the looks around direction `j` met, if all met the same; nothing in the first step, and where steps are not known.
    fn agreed(&self, j: usize, blocked: &[u8]) -> Option<bool> {
        let around = self.lists.get(j.checked_sub(self.first)?)?;
        match around.iter().map(|&k| blocked[k as usize]).sum::<u8>() {
            0 => Some(false),
            n if n as usize == AROUND => Some(true),
            _ => None,
        }
    }
}

/// Points of the unit disk in square cells, to find those near a point.
struct Grid<'a> {
    xs: &'a [f32],
    ys: &'a [f32],
    cells: usize,
    starts: Vec<u32>,
    members: Vec<u16>,
}

impl<'a> Grid<'a> {
    /// About four points to a cell: the nearest eight are then mostly in the cells beside.
    fn new(xs: &'a [f32], ys: &'a [f32]) -> Self {
        let cells = (xs.len() as f32 * 0.32).sqrt().ceil() as usize;
        let mut grid = Self { xs, ys, cells, starts: vec![0; cells * cells + 1], members: vec![0; xs.len()] };
        for j in 0..xs.len() {
            let cell = grid.cell([xs[j], ys[j]]);
            grid.starts[cell[1] * cells + cell[0] + 1] += 1;
        }
        for k in 1..grid.starts.len() {
            grid.starts[k] += grid.starts[k - 1];
        }
        let mut next = grid.starts.clone();
        for j in 0..xs.len() {
            let cell = grid.cell([xs[j], ys[j]]);
            let slot = &mut next[cell[1] * cells + cell[0]];
            grid.members[*slot as usize] = j as u16;
            *slot += 1;
        }
        grid
    }

    fn cell(&self, point: [f32; 2]) -> [usize; 2] {
        point.map(|x| (((x + 1.0) * 0.5 * self.cells as f32) as usize).min(self.cells - 1))
    }

    /// The [`AROUND`] points nearest to a point, from the nearest on.
    fn nearest(&self, point: [f32; 2]) -> [u16; AROUND] {
        let width = 2.0 / self.cells as f32;
        let mut best = [(f32::INFINITY, 0); AROUND];
        for reach in 1..=self.cells {
            best.fill((f32::INFINITY, 0));
            self.within(point, reach, &mut best);
            // What lies outside of the cells looked at is farther than `reach` whole cells.
            if best[AROUND - 1].0 <= (reach as f32 * width).powi(2) {
                break;
            }
        }
        best.map(|(_, j)| j)
    }

    fn within(&self, point: [f32; 2], reach: usize, best: &mut [(f32, u16); AROUND]) {
        let [column, row] = self.cell(point);
        let last = self.cells - 1;
        for y in row.saturating_sub(reach)..=(row + reach).min(last) {
            let left = y * self.cells + column.saturating_sub(reach);
            let right = y * self.cells + (column + reach).min(last);
            for &j in &self.members[self.starts[left] as usize..self.starts[right + 1] as usize] {
                let (dx, dy) = (self.xs[j as usize] - point[0], self.ys[j as usize] - point[1]);
                let distance = dx * dx + dy * dy;
                if distance < best[AROUND - 1].0 {
                    best[AROUND - 1] = (distance, j);
                    for k in (1..AROUND).rev() {
                        if best[k].0 < best[k - 1].0 {
                            best.swap(k, k - 1);
                        }
                    }
                }
            }
        }
    }
}

/// The rays of one step, and what the others are taken to meet.
#[derive(Debug, Default)]
pub(crate) struct Choice {
    /// Directions to trace, in their order.
    pub(crate) traced: Vec<u32>,
    /// Of each: what it was foreseen to meet, 2 where nothing was.
    foreseen: Vec<u8>,
    /// Directions foreseen to be open and to be blocked, and how many of each are traced.
    members: [u32; 2],
    tried: [u32; 2],
}

impl Choice {
    /// Chooses the rays of directions `range`; the others get their foreseen state in `blocked`. `turn` shifts which part of the
    /// foreseen is tried.
    pub(crate) fn choose(
        &mut self,
        around: &Surroundings,
        range: std::ops::Range<usize>,
        turn: u32,
        blocked: &mut Vec<u8>,
    ) {
        self.traced.clear();
        self.foreseen.clear();
        (self.members, self.tried) = ([0; 2], [0; 2]);
        for j in range {
            let Some(is_blocked) = around.agreed(j, blocked) else {
                self.traced.push(j as u32);
                self.foreseen.push(2);
                blocked.push(0);
                continue;
            };
            let class = usize::from(is_blocked);
            if (self.members[class] % PART + turn % PART).is_multiple_of(PART) {
                self.traced.push(j as u32);
                self.foreseen.push(class as u8);
                self.tried[class] += 1;
            }
            self.members[class] += 1;
            blocked.push(class as u8);
        }
    }

    /// Share of a foreseen direction's weight that one that was tried and met otherwise counts for.
    fn factor(&self, class: u8) -> f32 {
        let class = class as usize;
        self.members[class] as f32 / self.tried[class] as f32
    }

    /// Enters what the traced rays met into `blocked`, and appends to `open` how much each direction of the step (which begins at
    /// `start`) adds to the open sum: 1 or 0, and more or less where a foreseen one met otherwise. `passed` holds the share of light that
    /// rays which are not blocked pass; empty where that is all.
    pub(crate) fn settle(&self, start: usize, met: &[u64], passed: &[f32], blocked: &mut [u8], open: &mut Vec<f32>) {
        debug_assert_eq!(open.len(), start, "step follows step");
        open.extend(blocked[start..].iter().map(|&state| if state == 0 { 1.0 } else { 0.0 }));
        for (k, (&j, &foreseen)) in self.traced.iter().zip(&self.foreseen).enumerate() {
            let mut state = (met[k / 64] >> (k % 64) & 1) as u8;
            let mut value = if state == 0 { 1.0 } else { 0.0 };
            if let Some(&share) = passed.get(k).filter(|&&share| share != 1.0 && state == 0) {
                (state, value) = (if share == 0.0 { 1 } else { PARTLY }, share);
            }
            blocked[j as usize] = state;
            let out = &mut open[j as usize];
            *out =
                if foreseen == 2 || foreseen == state { value } else { *out + (value - *out) * self.factor(foreseen) };
        }
    }
}

impl Choice {
    /// Appends to `open` what [`Choice::settle`] would, before it, for another share that rays pass: one channel of a tint.
    pub(crate) fn settle_channel(
        &self,
        start: usize,
        met: &[u64],
        passed: impl Fn(usize) -> f32,
        blocked: &[u8],
        open: &mut Vec<f32>,
    ) {
        open.extend(blocked[start..].iter().map(|&state| if state == 0 { 1.0 } else { 0.0 }));
        for (k, (&j, &foreseen)) in self.traced.iter().zip(&self.foreseen).enumerate() {
            let value = if met[k / 64] >> (k % 64) & 1 == 1 { 0.0 } else { passed(k) };
            let out = &mut open[j as usize];
            *out = if foreseen == 2 || value == *out { value } else { *out + (value - *out) * self.factor(foreseen) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{AROUND, Choice, Surroundings};
    use glam::Vec2;
    use sampling::sequence::{Sequence, fill};
    use sampling::warp::square_to_cosine_hemisphere;

    const ENDS: [usize; 4] = [128, 256, 512, 1024];

    fn disk(seed: u64) -> Vec<Vec2> {
        let mut points = Vec::new();
        fill(Sequence::OwenSobol, ENDS[3] as u32, seed, &mut points);
        points.into_iter().map(|p| square_to_cosine_hemisphere(p).truncate()).collect()
    }

    fn surroundings(disk: &[Vec2]) -> Surroundings {
        let axis = |k: usize| disk.iter().map(|p| p[k]).collect::<Vec<f32>>();
        Surroundings::new(&axis(0), &axis(1), &ENDS)
    }

    /// The lists against a search of all earlier directions, by their distances: points as far may stand for one another.
    #[test]
    fn surroundings_are_the_nearest_of_earlier_steps() {
        let disk = disk(1);
        let around = surroundings(&disk);
        for j in ENDS[0]..ENDS[3] {
            let before = ENDS.into_iter().filter(|&end| end <= j).max().expect("after the first step");
            let mut all: Vec<f32> = disk[..before].iter().map(|p| p.distance_squared(disk[j])).collect();
            all.sort_by(f32::total_cmp);
            let found = around.lists[j - ENDS[0]].map(|k| disk[k as usize].distance_squared(disk[j]));
            assert_eq!(found, all[..AROUND], "direction {j}");
        }
    }

    /// Share that is open beyond a roof that leaves a round hole of radius `hole` at `middle`; and the rays traced. With `trust`,
    /// what is foreseen is taken for what was met.
    fn open_share(seed: u64, middle: Vec2, hole: f32, trust: bool) -> [f64; 2] {
        let disk = disk(seed);
        let (around, mut choice) = (surroundings(&disk), Choice::default());
        let (mut blocked, mut open, mut start) = (Vec::new(), Vec::new(), 0);
        let (mut sum, mut rays) = (0.0, 0);
        for end in ENDS {
            choice.choose(&around, start..end, (seed / 7) as u32, &mut blocked);
            let mut met = vec![0u64; choice.traced.len().div_ceil(64)];
            for (k, &j) in choice.traced.iter().enumerate() {
                if disk[j as usize].distance(middle) > hole {
                    met[k / 64] |= 1 << (k % 64);
                }
            }
            choice.settle(start, &met, &[], &mut blocked, &mut open);
            if trust {
                open = blocked.iter().map(|&state| f32::from(1 - state)).collect();
            }
            sum += open[start..].iter().map(|&x| f64::from(x)).sum::<f64>();
            rays += choice.traced.len();
            start = end;
        }
        [sum / ENDS[3] as f64, rays as f64]
    }

    /// A hole that few rays meet has its area on the average over many sets; trusting what is foreseen loses a part of it.
    #[test]
    fn foresight_is_unbiased() {
        const SEEDS: u64 = 2000;
        let (middle, hole) = (Vec2::new(0.31, -0.22), 0.04);
        let statistics = |trust| {
            let shares: Vec<f64> = (0..SEEDS).map(|seed| open_share(seed, middle, hole, trust)[0]).collect();
            let mean = shares.iter().sum::<f64>() / SEEDS as f64;
            let variance = shares.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / (SEEDS - 1) as f64;
            (mean, (variance / SEEDS as f64).sqrt())
        };
        let area = f64::from(hole * hole);
        let (mean, error) = statistics(false);
        assert!((mean - area).abs() < 3.5 * error, "{mean} +- {error}, exact {area}");
        let (mean, error) = statistics(true);
        assert!((mean - area).abs() > 5.0 * error, "the check sees a bias: {mean} +- {error}, exact {area}");
    }

    /// A large hole costs rays along its edge only, and a closed roof one in three after the first step.
    #[test]
    fn rays_go_to_the_edges() {
        let [share, rays] = open_share(5, Vec2::ZERO, 0.6, false);
        assert!((share - 0.36).abs() < 0.004, "open share {share}");
        assert!(rays < 0.65 * 1024.0, "{rays} of 1024");
        let [share, rays] = open_share(5, Vec2::ZERO, 0.0, false);
        assert_eq!(share, 0.0);
        assert!((rays - (128.0 + 896.0 / 3.0)).abs() <= 3.0, "{rays}");
    }
}
