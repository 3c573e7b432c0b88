//! Environments stepped together on several threads, with the GIL released.

use crate::environment::{Episode, Kind, World};
use crate::errors::{self, SpandrelError};
use crate::job;
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use spandrel_sitl::testing::MissedExpectation;
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};
use std::thread;

/// One environment: its episode and pending reset.
#[derive(Debug, Default)]
struct Slot {
    episode: Option<Episode>,
    /// Seed and initial state of the latest reset. Resetting with the same seed restores a bit-identical copy.
    initial_episode: Option<(u64, Episode)>,
    /// Seed of a pending reset.
    reset: Option<u64>,
    result: SlotResult,
}

#[derive(Debug, Default)]
struct SlotResult {
    observation: Vec<f32>,
    reward: f64,
    terminated: bool,
    measures: [f64; 2],
    failure: Option<MissedExpectation>,
}

impl Slot {
    /// Resets the environment if a reset is pending, otherwise steps it.
    fn reset_or_step(&mut self, world: &Arc<World>, action: Option<&[f32]>) {
        self.result.reward = 0.0;
        self.result.terminated = false;
        self.result.failure = None;
        if let Some(seed) = self.reset.take() {
            self.result.measures = [0.0; 2];
            match self.initial_state(world, seed) {
                Ok(episode) => self.episode = Some(episode),
                Err(failure) => self.result.failure = Some(failure),
            }
        } else if let (Some(episode), Some(action)) = (&mut self.episode, action) {
            let outcome = episode.step(action);
            self.result.reward = outcome.reward;
            self.result.terminated = outcome.terminated;
            self.result.measures = outcome.measures;
        }
        self.result.observation.clear();
        if let Some(episode) = &self.episode {
            episode.observe(&mut self.result.observation);
        }
    }

    fn initial_state(&mut self, world: &Arc<World>, seed: u64) -> Result<Episode, MissedExpectation> {
        match &self.initial_episode {
            Some((before, episode)) if *before == seed => Ok(episode.clone()),
            _ => {
                let episode = Episode::start(world, seed)?;
                self.initial_episode = Some((seed, episode.clone()));
                Ok(episode)
            }
        }
    }
}

/// Observations (float32), rewards (float64), terminations (bool) and measures (float64, two per environment), all as bytes.
type StepBytes = (Py<PyBytes>, Py<PyBytes>, Py<PyBytes>, Py<PyBytes>);

/// Several environments of one kind, wrapped by the Gymnasium environments.
#[pyclass(frozen, module = "spandrel._spandrel")]
pub struct Batch {
    world: Arc<World>,
    threads: usize,
    slots: Mutex<Vec<Slot>>,
}

#[pymethods]
impl Batch {
    #[new]
    fn new(kind: &str, scenario: &str, vehicle: &str, count: usize, threads: usize) -> PyResult<Self> {
        let kind = match kind {
            "hover" => Kind::Hover,
            "inspect" => Kind::Inspect,
            _ => return Err(PyValueError::new_err(format!("unknown environment {kind}; allowed: hover, inspect"))),
        };
        if count == 0 {
            return Err(PyValueError::new_err("at least one environment is required"));
        }
        let threads = match threads {
            0 => thread::available_parallelism().map_or(1, usize::from),
            n => n,
        };
        let world = World { kind, job: job::read_scenario(scenario)?, aircraft: job::read_vehicle(vehicle)? };
        let slots = (0..count).map(|_| Slot::default()).collect();
        Ok(Self { world: Arc::new(world), threads: threads.min(count), slots: Mutex::new(slots) })
    }

    /// Returns the simulation time per step in seconds.
    fn step_s(&self) -> f64 {
        self.world.kind.step().s()
    }

    /// Returns the observation length.
    fn observations(&self) -> usize {
        self.world.kind.observations()
    }

    /// Returns the minimum and maximum of each action component.
    fn action_limits(&self) -> Vec<(f64, f64)> {
        self.world.action_limits()
    }

    /// Resets the environments that have a seed, and leaves the rest unchanged.
    fn reset(&self, py: Python<'_>, seeds: Vec<Option<u64>>) -> PyResult<StepBytes> {
        self.reset_or_step(py, seeds, None)
    }

    /// Steps the environments without a seed with their actions (float32, one row each), and resets the environments
    /// with a seed.
    fn step(&self, py: Python<'_>, actions: &[u8], seeds: Vec<Option<u64>>) -> PyResult<StepBytes> {
        let (floats, _) = actions.as_chunks::<4>();
        let actions: Vec<f32> = floats.iter().map(|bytes| f32::from_ne_bytes(*bytes)).collect();
        if actions.iter().any(|value| !value.is_finite()) {
            return Err(PyValueError::new_err("an action contains a value that is not finite"));
        }
        self.reset_or_step(py, seeds, Some(actions))
    }

    /// Returns the SHA-256 of the state at every tick of one environment's episode, as 64 hexadecimal digits.
    fn digest(&self, index: usize) -> PyResult<String> {
        self.with_episode(index, |episode| episode.digest().iter().map(|byte| format!("{byte:02x}")).collect())
    }

    /// Returns the simulation time of one environment in seconds.
    fn time_s(&self, index: usize) -> PyResult<f64> {
        self.with_episode(index, Episode::time_s)
    }
}

impl Batch {
    /// Acquires the lock without blocking, because its holder may need the GIL to finish.
    fn lock(&self) -> PyResult<MutexGuard<'_, Vec<Slot>>> {
        match self.slots.try_lock() {
            Ok(slots) => Ok(slots),
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => Err(SpandrelError::new_err("another thread is stepping these environments")),
        }
    }

    fn with_episode<T>(&self, index: usize, read: impl FnOnce(&Episode) -> T) -> PyResult<T> {
        let slots = self.lock()?;
        let episode = slots.get(index).and_then(|slot| slot.episode.as_ref());
        episode
            .map(read)
            .ok_or_else(|| PyIndexError::new_err(format!("environment {index} does not exist or has never been reset")))
    }

    fn reset_or_step(&self, py: Python<'_>, seeds: Vec<Option<u64>>, actions: Option<Vec<f32>>) -> PyResult<StepBytes> {
        let width = self.world.kind.actions();
        let mut guard = self.lock()?;
        let slots = &mut *guard;
        let count = slots.len();
        if seeds.len() != count || actions.as_ref().is_some_and(|actions| actions.len() != count * width) {
            let words = format!("{count} environments require {count} seeds and {count} x {width} numbers as actions");
            return Err(PyValueError::new_err(words));
        }
        for (slot, seed) in slots.iter_mut().zip(seeds) {
            slot.reset = seed;
            if slot.reset.is_none() && slot.episode.is_none() {
                return Err(PyValueError::new_err("reset every environment before the first step"));
            }
        }
        py.detach(|| self.run(slots, actions.as_deref(), width));
        if let Some(failure) = slots.iter().find_map(|slot| slot.result.failure.as_ref()) {
            return Err(errors::failure(failure));
        }
        Ok(collect(py, slots))
    }

    /// Steps the environments, which are divided evenly among the threads.
    fn run(&self, slots: &mut [Slot], actions: Option<&[f32]>, width: usize) {
        let share = slots.len().div_ceil(self.threads);
        let world = &self.world;
        let turns = |first: usize, slots: &mut [Slot]| {
            for (k, slot) in slots.iter_mut().enumerate() {
                let from = (first + k) * width;
                slot.reset_or_step(world, actions.and_then(|actions| actions.get(from..from + width)));
            }
        };
        if self.threads == 1 {
            turns(0, slots);
            return;
        }
        thread::scope(|scope| {
            for (k, slots) in slots.chunks_mut(share).enumerate() {
                let turns = &turns;
                scope.spawn(move || turns(k * share, slots));
            }
        });
    }
}

fn collect(py: Python<'_>, slots: &[Slot]) -> StepBytes {
    let results = || slots.iter().map(|slot| &slot.result);
    let observations: Vec<u8> = results().flat_map(|one| &one.observation).flat_map(|value| value.to_ne_bytes()).collect();
    let rewards: Vec<u8> = results().flat_map(|one| one.reward.to_ne_bytes()).collect();
    let terminated: Vec<u8> = results().map(|one| u8::from(one.terminated)).collect();
    let measures: Vec<u8> = results().flat_map(|one| one.measures).flat_map(f64::to_ne_bytes).collect();
    let bytes = |bytes: &[u8]| PyBytes::new(py, bytes).unbind();
    (bytes(&observations), bytes(&rewards), bytes(&terminated), bytes(&measures))
}
