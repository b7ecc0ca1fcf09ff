//! The choice of a path by what the processor can do, made once per tracer.

use crate::lanes::{Path, Portable};
#[cfg(target_arch = "x86_64")]
use crate::x86::{Avx2, Avx512};

/// The registers that a tracer uses. Answers are the same at every level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Level {
    /// No instructions beyond the target's own.
    #[default]
    Portable,
    /// Eight rays at a time with AVX2.
    Avx2,
    /// Sixteen rays at a time with AVX-512.
    Avx512,
}

impl Level {
    /// Every level that this processor has, the plainest first.
    pub fn available() -> Vec<Level> {
        #[cfg_attr(not(target_arch = "x86_64"), expect(unused_mut, reason = "nothing to add there"))]
        let mut levels = vec![Level::Portable];
        #[cfg(target_arch = "x86_64")]
        {
            let has = [
                is_x86_feature_detected!("avx2"),
                is_x86_feature_detected!("bmi1"),
                is_x86_feature_detected!("bmi2"),
                is_x86_feature_detected!("lzcnt"),
                is_x86_feature_detected!("popcnt"),
            ];
            if has == [true; 5] {
                levels.push(Level::Avx2);
                if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl") {
                    levels.push(Level::Avx512);
                }
            }
        }
        levels
    }

    /// The best level of this processor.
    pub fn best() -> Level {
        Level::available().last().copied().unwrap_or_default()
    }
}

/// Work that is compiled once for each level; `run` must be inlined whole, to be compiled for the level's processor.
pub(crate) trait Job {
    type Output;
    fn run<P: Path>(self) -> Self::Output;
}

/// Does a job at a level that `available` listed.
#[cfg(target_arch = "x86_64")]
#[expect(unsafe_code, reason = "a tracer's level is one that `available` has found on this processor")]
pub(crate) fn dispatch<J: Job>(level: Level, job: J) -> J::Output {
    match level {
        Level::Portable => job.run::<Portable>(),
        Level::Avx2 => unsafe { with_avx2(job) },
        Level::Avx512 => unsafe { with_avx512(job) },
    }
}

/// Does a job: away from x86-64 there is one way.
#[cfg(not(target_arch = "x86_64"))]
pub(crate) fn dispatch<J: Job>(_level: Level, job: J) -> J::Output {
    job.run::<Portable>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn with_avx2<J: Job>(job: J) -> J::Output {
    job.run::<Avx2>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx2,bmi1,bmi2,lzcnt,popcnt")]
fn with_avx512<J: Job>(job: J) -> J::Output {
    job.run::<Avx512>()
}
