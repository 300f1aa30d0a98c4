//! Seeded random streams: one per cause and per run.
//!
//! Because every cause of randomness has a generator of its own, switching one fault on moves no other draw, and because
//! nothing depends on the filter or on the thread, all filters meet the same worlds.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

/// The generator behind every stream; part of an FMU's saved state.
pub type Generator = Xoshiro256PlusPlus;

/// A cause of randomness. The numbers are part of the study's definition: never renumber, only append.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Source {
    /// Error of the initial estimate.
    InitialError = 1,
    /// Time of the first vent.
    VentTiming = 2,
    /// Magnitudes of the carbon-dioxide vents.
    VentSizeCo2 = 3,
    /// Magnitude of the waste-water vent.
    VentSizeWater = 4,
    /// LiDAR range and angle noise.
    Lidar = 5,
    /// Accelerometer sample noise.
    Accelerometer = 6,
    /// Accelerometer bias walk.
    AccelerometerBias = 7,
    /// Which samples drop out.
    Dropout = 8,
    /// Which samples are outliers.
    Outlier = 9,
    /// The adaptation's random start of s.
    AdaptationStart = 10,
    /// Centres and start weights of the radial-basis network.
    NetworkCentres = 11,
    /// Metrology noise of the formation world.
    Metrology = 12,
    /// Parameters that a study varies from run to run.
    Variation = 13,
    /// Shift of the points that a search for the best tuning tries.
    Search = 14,
    /// Magnitudes of the vents of a named kind.
    VentSize = 15,
    /// Directions of the vents of a named kind.
    VentDirection = 16,
    /// Noise of a named sensor of the target.
    SensorNoise = 17,
    /// Points of the Latin hypercubes of a study's grids.
    Grid = 18,
    /// Runs whose signs are flipped, for what chance makes of a mean error.
    SignFlip = 19,
    /// Runs drawn again, for the intervals of a statistic.
    Bootstrap = 20,
    /// The linear system that statistics are tried on.
    Calibration = 21,
    /// The target's acceleration that wanders.
    Wander = 22,
    /// The target's white acceleration.
    WhiteAcceleration = 23,
}

/// Generator for one cause of randomness in one run; equal arguments give equal streams.
pub fn stream(study_seed: u64, run: u64, source: Source) -> Generator {
    Generator::seed_from_u64(mix(study_seed ^ mix(run ^ mix(source as u64))))
}

/// Generator for one cause of randomness of one named entry; equal arguments give equal streams, another name another.
pub fn named_stream(study_seed: u64, run: u64, source: Source, name: &str) -> Generator {
    // FNV-1a, so that a stream is the same on every platform and in every release.
    let hash = name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    Generator::seed_from_u64(mix(study_seed ^ mix(run ^ mix(source as u64 ^ mix(hash)))))
}

/// The splitmix64 finaliser: a bijection of 64-bit words that leaves no visible structure of its argument.
fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng;
    use std::collections::HashSet;

    #[test]
    fn equal_arguments_give_equal_streams_and_others_differ() {
        let first = |seed, run, source| stream(seed, run, source).next_u64();
        assert_eq!(first(1, 2, Source::Lidar), first(1, 2, Source::Lidar));
        let mut seen = HashSet::new();
        for seed in 0..20 {
            for run in 0..20 {
                for source in [Source::Lidar, Source::Dropout, Source::InitialError] {
                    assert!(
                        seen.insert(first(seed, run, source)),
                        "collision at {seed}, {run}, {source:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn names_select_streams_of_their_own() {
        let first = |name| named_stream(1, 2, Source::VentSize, name).next_u64();
        assert_eq!(first("co2"), first("co2"));
        assert_ne!(first("co2"), first("co3"));
        assert_ne!(first("co2"), named_stream(1, 2, Source::VentTiming, "co2").next_u64());
        assert_ne!(first(""), stream(1, 2, Source::VentSize).next_u64());
    }

    #[test]
    fn a_saved_stream_goes_on_where_it_stood() {
        let mut a = stream(3, 4, Source::Accelerometer);
        a.next_u64();
        let mut b = a.clone();
        assert_eq!(a.next_u64(), b.next_u64());
    }
}
