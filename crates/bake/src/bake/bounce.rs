//! The bounces of a bake, one by one, and the tail of their series.

use super::Run;
use crate::Error;
use crate::arrival::radiance;
use crate::field::Field;
use crate::gloss::fixed;
use crate::passes::{Chunk, bounce_pass};
use crate::plan::tolerance;
use crate::repair::Repair;
use crate::series::{self, Tail};
use coeff_io::Bounces;

impl Run<'_> {
    /// Bounces until the count asked for, or until what is still to come is below the tolerance; where bounces fade slowly the tail of
    /// their series is summed in closed form.
    pub(super) fn bounce(&mut self, chunks: &[Chunk], repair: &Repair, transfer: &mut Field) -> Result<(), Error> {
        let auto = self.settings.bounces == Bounces::Auto;
        let limit = match self.settings.bounces {
            Bounces::Fixed(n) => n,
            // What comes after these cannot matter; they end sooner where measured to.
            Bounces::Auto => self.plan.bounces.min(series::MOST),
        };
        let (mut earlier, mut before, mut slowest) = (0.0f64, 1.0f64, 0.0f64);
        for n in 1..=limit {
            let mut next = bounce_pass(&self.gatherer, &self.receivers, chunks, &self.last, n, &self.monitor)?;
            if let Some(mut glints) = self.glints.take_if(|_| n == 1) {
                glints.grow(self.receivers.list.len());
                next.add(&glints);
            }
            repair.apply(&mut next);
            let tail = match auto && n > series::FIRST {
                true if n % 2 == 1 => {
                    Some(series::tail(&self.last, &next).unwrap_or_else(|| series::smoothed(&self.last, &next)))
                }
                true => series::tail(&self.last, &next),
                false => None,
            };
            let summed = tail.is_some();
            if let Some(tail) = tail {
                slowest = slowest.max(tail.ratio);
                next = self.add_tail(tail, transfer);
            }
            transfer.add(&next);
            let change = self.largest_norm(&next);
            self.achieved.bounces = n;
            self.achieved.bounce_changes.push(change as f32);
            self.last = next;
            // What the last bounce leaves behind nobody receives.
            if self.settings.bounces != Bounces::Fixed(n) {
                self.note_radiance();
            }
            // What a tail leaves fades fast at first, but no slower in the end than the bounces did.
            let ratio = match before {
                // The first is against the direct light of an open receiver: where all are covered it says nothing of what follows.
                _ if n == 1 => change.max(f64::from(self.plan.survey.coverage[0])),
                before if before > 0.0 => change / before,
                _ => 0.0,
            };
            let mut left = series::remainder(change, ratio.max(slowest));
            if n > 2 && slowest == 0.0 {
                left = left.max(series::remainder_of_pairs([earlier, before, change]));
            }
            if slowest > 0.0 || auto && n == series::MOST {
                self.achieved.remainder = Some(left.min(f64::from(f32::MAX)) as f32);
            }
            if auto && !summed && left <= f64::from(tolerance(self.settings.quality)) {
                break;
            }
            (earlier, before) = (before, change);
        }
        Ok(())
    }

    /// Adds the tail of the series after the last bounce; returns what takes the place of the next.
    fn add_tail(&mut self, tail: Tail, transfer: &mut Field) -> Field {
        transfer.add(&tail.sum);
        self.last = tail.sum;
        self.note_radiance();
        tail.rest
    }

    /// Keeps the radiance of the last bounce under the light that goes into gloss.
    pub(super) fn note_radiance(&mut self) {
        if let Some(light) = self.light.filter(|_| self.gatherer.mirrors.is_some()) {
            let light = &light.coefficients[..self.last.coefficients];
            fixed::add_table(&mut self.radiance, radiance(&self.last, self.receivers.list.len(), light));
        }
    }
}
