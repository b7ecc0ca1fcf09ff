//! The doubling rule decides as it says; replicates average as they say.

use sampling::estimate::{Doubling, Replicates, Verdict};
use testkit::assert_close;

const RULE: Doubling = Doubling { first: 64, last: 1000, tolerance: 0.1, confirmation: f64::INFINITY, memory: 1 };

/// Feeds one-number estimates until the rule stops; counts and the last verdict.
fn run(rule: &Doubling, estimates: &[f64]) -> (Vec<u32>, Verdict) {
    let mut progress = rule.start();
    let mut counts = vec![rule.first];
    for &value in estimates {
        match rule.look(&mut progress, *counts.last().expect("never empty"), &[value]) {
            Verdict::Continue { count } => counts.push(count),
            verdict => return (counts, verdict),
        }
    }
    panic!("the rule wants more than {} estimates", estimates.len());
}

#[test]
fn stops_at_the_first_small_change() {
    let (counts, verdict) = run(&RULE, &[1.0, 0.5, 0.45, 9.0]);
    assert_eq!(counts, [64, 128, 256]);
    let Verdict::Reached { error } = verdict else { panic!("{verdict:?}") };
    assert_close!(error, 0.05, 1e-12, 0.0);
}

#[test]
fn two_passes_ask_for_confirmation() {
    let rule = Doubling { confirmation: 1.0, ..RULE };
    let (counts, verdict) = run(&rule, &[1.0, 0.95, 0.5, 0.52, 0.53]);
    assert_eq!(counts, [64, 128, 256, 512, 1000], "the change at 256 starts the count anew");
    assert!(matches!(verdict, Verdict::Reached { .. }), "{verdict:?}");
}

/// Changes that fall as `N^-0.65` say the same at every look, however many are remembered; a lucky small one among them counts for
/// its share only.
#[test]
fn remembered_changes_are_brought_to_the_present_count() {
    let change = |look: i32| 0.3 * 2.0_f64.powf(-0.65).powi(look);
    let mut estimates = vec![0.0];
    for look in 1..=4 {
        estimates.push(estimates[look as usize - 1] + change(look));
    }
    let rule = |memory| Doubling { last: 1024, tolerance: 0.0, memory, ..RULE };
    for memory in [1, 2, 3, 4, 9] {
        let Verdict::Exhausted { error } = run(&rule(memory), &estimates).1 else { panic!("no change is small") };
        assert_close!(error, change(4), 1e-12, 0.0);
    }
    estimates[4] = estimates[3];
    let last = |memory| match run(&rule(memory), &estimates).1 {
        Verdict::Reached { error } | Verdict::Exhausted { error } => error,
        Verdict::Continue { .. } => panic!("the limit is spent"),
    };
    assert_close!(last(4), (0.75_f64).sqrt() * change(4), 1e-12, 0.0);
    assert_close!(last(1), 0.0, 0.0, 0.0);
}

/// A blocker that only the last look finds is not lost among the looks before it that found nothing.
#[test]
fn what_is_found_late_counts() {
    // A tolerance that no change meets, so that the rule sees all looks.
    let rule = Doubling { last: 1024, tolerance: -1.0, memory: 4, ..RULE };
    let Verdict::Exhausted { error } = run(&rule, &[1.0, 1.0, 1.0, 1.0, 1.2]).1 else {
        panic!("no change is less than nothing")
    };
    assert_close!(error, 0.2 / 2.0_f64.sqrt(), 1e-12, 0.0);
}

#[test]
fn noise_can_fail() {
    let (counts, verdict) = run(&RULE, &[0.0, 1.0, 0.0, 1.0, 0.0]);
    assert_eq!(counts, [64, 128, 256, 512, 1000]);
    assert_eq!(verdict, Verdict::Exhausted { error: 1.0 });
    let nan = run(&Doubling { last: 128, ..RULE }, &[0.0, f64::NAN]).1;
    assert!(matches!(nan, Verdict::Exhausted { .. }), "NaN never passes");
}

#[test]
fn a_single_look_knows_no_error() {
    assert_eq!(run(&Doubling { last: 64, ..RULE }, &[1.0]).1, Verdict::Exhausted { error: f64::INFINITY });
}

#[test]
fn replicates_equal_the_textbook() {
    let mut replicates = Replicates::default();
    for estimate in [[1.0, 5.0], [2.0, 5.0], [6.0, 5.0]] {
        replicates.add(&estimate);
    }
    assert_eq!(replicates.mean(), [3.0, 5.0]);
    // Deviations -2, -1, 3: variance 14 / 2, of the mean 7 / 3.
    assert_close!(replicates.std_error()[0], (7.0_f64 / 3.0).sqrt(), 1e-12, 0.0);
    assert_close!(replicates.std_error()[1], 0.0, 0.0, 0.0);
    assert_close!(replicates.l2_error(), (7.0_f64 / 3.0).sqrt(), 1e-12, 0.0);
}

#[test]
fn one_replicate_can_fail() {
    let mut replicates = Replicates::default();
    replicates.add(&[1.0]);
    assert!(replicates.l2_error().is_infinite(), "one estimate knows no error");
}
