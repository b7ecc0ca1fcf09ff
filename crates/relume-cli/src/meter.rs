//! How far a command is and how long it still takes, over all of its stages.

use std::time::{Duration, Instant};

/// A stage tells little of its own speed before this share of it is done.
const EARLY: f64 = 0.02;

/// Share of what was left of a stage that one more pass over it does, where nobody knows how many follow.
const PASS: f64 = 0.5;

/// The largest share that is shown while there is work.
const NEARLY: f64 = 0.99;

/// A stage that is expected, with about its share of the whole.
#[derive(Debug, Clone, PartialEq)]
struct Expected {
    name: String,
    weight: f64,
    seconds: f64,
    done: bool,
}

/// Stages that are expected and those that came; the share done never falls.
#[derive(Debug)]
pub(crate) struct Meter {
    began: Instant,
    stages: Vec<Expected>,
    current: Option<Current>,
    shown: f64,
}

#[derive(Debug)]
struct Current {
    stage: usize,
    began: Instant,
    /// Where the pass under way began, and the last share that was told of it.
    base: f64,
    last: f64,
    share: f64,
}

/// What is to be shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reading {
    /// Share of the whole, by time.
    pub(crate) share: f64,
    /// Time that is left, where it can be told.
    pub(crate) left: Option<Duration>,
    /// Whether the stage has just come up for the first time.
    pub(crate) new: bool,
}

impl Meter {
    pub(crate) fn new(began: Instant) -> Meter {
        Meter { began, stages: Vec::new(), current: None, shown: 0.0 }
    }

    /// Says which stages will come, with about how long each takes against the others.
    pub(crate) fn expect(&mut self, stages: &[(&str, f64)]) {
        for &(name, weight) in stages {
            if !self.stages.iter().any(|stage| stage.name == name) {
                self.stages.push(Expected { name: name.to_owned(), weight, seconds: 0.0, done: false });
            }
        }
    }

    /// Notes that `share` of a pass over a stage is done; a stage may take several passes.
    pub(crate) fn set(&mut self, name: &str, share: f64, now: Instant) -> Reading {
        let new = self.enter(name, now);
        if let Some(current) = &mut self.current {
            // A pass begins at nothing; of the threads of one some tell late what they did.
            if share <= 0.0 && current.last > 0.0 {
                // One more pass has something to do.
                current.base = current.share.min(1.0 - EARLY);
                current.share = current.base;
            }
            current.last = if share <= 0.0 { 0.0 } else { current.last.max(share) };
            // The first pass may be all; a further one does a part of what is left.
            let part = if current.base > 0.0 { PASS } else { 1.0 };
            let reached = (current.base + (1.0 - current.base) * part * share).min(1.0);
            current.share = current.share.max(reached);
        }
        let left = self.left(now);
        let elapsed = now.saturating_duration_since(self.began).as_secs_f64();
        // What a stage that nobody expected takes says nothing of the whole.
        if let (Some(left), true) = (left, self.stages.iter().any(|stage| stage.weight > 0.0)) {
            self.shown = self.shown.max((elapsed / (elapsed + left).max(f64::MIN_POSITIVE)).min(NEARLY));
        }
        Reading { share: self.shown, left: left.map(Duration::from_secs_f64), new }
    }

    /// Turns to a stage; whether it is met for the first time.
    fn enter(&mut self, name: &str, now: Instant) -> bool {
        if self.current.as_ref().is_some_and(|current| self.stages[current.stage].name == name) {
            return false;
        }
        if let Some(current) = self.current.take() {
            let stage = &mut self.stages[current.stage];
            stage.seconds += now.saturating_duration_since(current.began).as_secs_f64();
            stage.done = true;
        }
        let known = self.stages.iter().position(|stage| stage.name == name);
        let index = known.unwrap_or_else(|| {
            // Unforeseen: it says nothing of the others.
            self.stages.push(Expected { name: name.to_owned(), weight: 0.0, seconds: 0.0, done: false });
            self.stages.len() - 1
        });
        // What was expected before it does not come.
        if known.is_some() {
            self.stages[..index].iter_mut().for_each(|stage| stage.done = true);
        }
        let new = !self.stages[index].done && self.stages[index].seconds == 0.0;
        let share = if new { 0.0 } else { 1.0 - PASS };
        self.current = Some(Current { stage: index, began: now, base: share, last: 0.0, share });
        new
    }

    /// Seconds that are left: of this stage by its own speed, of the others by the speed of all so far.
    fn left(&self, now: Instant) -> Option<f64> {
        let current = self.current.as_ref()?;
        let spent = now.saturating_duration_since(current.began).as_secs_f64();
        let own = &self.stages[current.stage];
        let is_other = |(index, _): &(usize, &Expected)| *index != current.stage;
        let others = || self.stages.iter().enumerate().filter(is_other).map(|(_, stage)| stage);
        let seconds = spent
            + own.seconds
            + others().map(|stage| if stage.weight > 0.0 { stage.seconds } else { 0.0 }).sum::<f64>();
        let came = |stage: &Expected| if stage.seconds > 0.0 { stage.weight } else { 0.0 };
        let work = own.weight * current.share + others().map(came).sum::<f64>();
        let rest: f64 = others().filter(|stage| !stage.done).map(|stage| stage.weight).sum();
        if current.share < EARLY && work <= 0.0 {
            return None;
        }
        let pace = if work > 0.0 { seconds / work } else { 0.0 };
        let gained = current.share - current.base;
        let mine = match gained > EARLY {
            true => spent * (1.0 - current.share) / gained,
            false => own.weight * (1.0 - current.share) * pace,
        };
        Some(mine + rest * pace)
    }
}

/// A time in the unit that one would say it in.
pub(crate) fn in_words(time: Duration) -> String {
    match time.as_secs() {
        seconds @ 0..100 => format!("{} s", seconds.max(1)),
        seconds @ 100..6_000 => format!("{} min", (seconds + 30) / 60),
        seconds => format!("{:.1} h", seconds as f64 / 3_600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Plays stages of (name, seconds, steps) and returns the readings with the true time left.
    fn play(meter: &mut Meter, start: Instant, stages: &[(&str, f64, u32)]) -> Vec<(Reading, f64)> {
        let all: f64 = stages.iter().map(|stage| stage.1).sum();
        let (mut now, mut found) = (0.0, Vec::new());
        for &(name, seconds, steps) in stages {
            for step in 0..=steps {
                let share = f64::from(step) / f64::from(steps);
                let at = now + seconds * share;
                found.push((meter.set(name, share, start + Duration::from_secs_f64(at)), all - at));
            }
            now += seconds;
        }
        found
    }

    const STAGES: [(&str, f64); 3] = [("refinement", 1.0), ("visibility", 4.0), ("bounces", 2.0)];

    #[test]
    fn one_bar_for_all_stages() {
        let start = Instant::now();
        let mut meter = Meter::new(start);
        meter.expect(&STAGES);
        let found =
            play(&mut meter, start, &[("refinement", 10.0, 20), ("visibility", 40.0, 40), ("bounces", 20.0, 20)]);
        assert!(found.windows(2).all(|w| w[0].0.share <= w[1].0.share), "it never runs backwards");
        for (reading, left) in &found[2..] {
            let told = reading.left.expect("there is something to tell").as_secs_f64();
            assert!((told - left).abs() < 0.02 * 70.0, "{told} s told, {left} s left");
        }
    }

    /// Stages of other lengths than expected, several passes over one, one that was not expected, and one that does not come.
    #[test]
    fn surprises_never_turn_it_back() {
        let start = Instant::now();
        let mut meter = Meter::new(start);
        meter.expect(&STAGES);
        let came = [
            ("loading", 5.0, 1),
            ("refinement", 1.0, 5),
            ("refinement", 8.0, 5),
            ("refinement", 0.5, 5),
            ("visibility", 100.0, 30),
            ("helpers", 30.0, 9),
            ("visibility", 3.0, 3),
        ];
        let found = play(&mut meter, start, &came);
        assert!(found.windows(2).all(|w| w[0].0.share <= w[1].0.share), "it never runs backwards");
        assert!(found.iter().all(|(reading, _)| (0.0..=1.0).contains(&reading.share)), "a share");
        assert_eq!(found.iter().filter(|(reading, _)| reading.new).count(), 4, "each stage is new once");
    }

    /// A stage before it is known what will come, such as unwrapping, does not fill the bar.
    #[test]
    fn what_comes_before_the_plan_does_not_fill_the_bar() {
        let start = Instant::now();
        let shown = |expected: &[(&str, f64)]| {
            let mut meter = Meter::new(start);
            meter.expect(expected);
            play(&mut meter, start, &[("charts", 2.0, 4)]).last().expect("some").0.share
        };
        assert_eq!(shown(&[]), 0.0);
        // Twin: a stage that is the whole of its command fills it.
        assert_eq!(shown(&[("charts", 1.0)]), NEARLY);
    }

    /// Threads tell late what they did: no further pass begins.
    #[test]
    fn late_news_are_no_new_pass() {
        let start = Instant::now();
        let mut meter = Meter::new(start);
        meter.expect(&[("visibility", 1.0)]);
        let mut last = None;
        for step in 0..=100 {
            let share = f64::from(step - 2 * (step % 2)).max(0.5) / 100.0;
            last = meter.set("visibility", share, start + Duration::from_secs_f64(f64::from(step))).left;
        }
        assert!(last.expect("known").as_secs_f64() < 0.01, "{last:?}");
    }

    /// A bar of each stage by itself, as it would be without a meter.
    #[test]
    fn surprises_never_turn_it_back_can_fail() {
        let shares = [0.0, 0.5, 1.0, 0.0, 0.5, 1.0];
        assert!(shares.windows(2).any(|w| w[0] > w[1]));
    }

    #[test]
    fn times_are_told_in_their_unit() {
        let told = [0, 42, 600, 7_200].map(|seconds| in_words(Duration::from_secs(seconds)));
        assert_eq!(told, ["1 s", "42 s", "10 min", "2.0 h"]);
    }
}
