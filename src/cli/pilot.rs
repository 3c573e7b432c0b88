//! `spandrel pilot`: runs the sans-IO synthetic trainee with a socket and a clock.

use super::args::JobArgs;
use crate::errors::{AppError, EXIT_CODES};
use crate::io::addresses;
use crate::io::clock::Stopwatch;
use crate::io::files;
use crate::io::net::{NetEvent, SocketHub};
use crate::io::progress::ProgressLog;
use crate::io::stop::StopRequest;
use serde_json::json;
use spandrel_clients::pilot::{Pilot, PilotConfig, Skill, SkillFactor};
use spandrel_model::time::SimTime;
use std::net::{IpAddr, SocketAddr};
use std::str::FromStr;
use std::sync::Arc;
use std::time::Duration;

/// Maximum time to wait for a datagram.
const MAX_DATAGRAM_WAIT: Duration = Duration::from_millis(50);
/// Wall time without a datagram after which a connected vehicle is considered lost.
const SILENCE_TIMEOUT: Duration = Duration::from_secs(10);

/// The synthetic trainee's numbers: a skill level or a file.
#[derive(Debug, Clone, clap::Args)]
pub struct SkillArgs {
    /// The synthetic trainee's skill level: novice, trained or expert
    #[arg(long, value_name = "SKILL", default_value = "trained", value_parser = ["novice", "trained", "expert"])]
    pub skill: String,
    /// Pilot file (TOML) that sets the synthetic trainee's numbers, instead of a skill level
    #[arg(long, value_name = "FILE", conflicts_with = "skill")]
    pub pilot: Option<String>,
    /// Numbers to take from the expert instead, to measure their individual effects: delay, gain, noise, preview, lapses,
    /// pace, search, photo, orientation, judgment
    #[arg(long, value_name = "FACTOR,...", value_delimiter = ',', value_parser = SkillFactor::from_str)]
    pub expert_in: Vec<SkillFactor>,
}

impl SkillArgs {
    /// Returns the synthetic trainee's numbers.
    ///
    /// # Errors
    /// Returns an error if there is no such skill level, or if the pilot file is invalid.
    pub fn skill(&self) -> Result<Skill, AppError> {
        let base = match &self.pilot {
            Some(file) => files::pilot(file)?,
            None => self.skill.parse::<Skill>().map_err(AppError::invalid)?,
        };
        Ok(self.expert_in.iter().fold(base, |pilot, factor| pilot.with(*factor, Skill::EXPERT)))
    }

    /// Returns a name for messages and for the default trainee ID.
    pub fn name(&self) -> &str {
        if self.pilot.is_some() { "pilot" } else { &self.skill }
    }

    /// Formats the options as command-line arguments for a child process.
    pub fn to_args(&self) -> Vec<String> {
        let mut args = match &self.pilot {
            Some(file) => vec!["--pilot".to_owned(), file.clone()],
            None => vec!["--skill".to_owned(), self.skill.clone()],
        };
        if !self.expert_in.is_empty() {
            let factors: Vec<&str> = self.expert_in.iter().map(|factor| factor.name()).collect();
            args.extend(["--expert-in".to_owned(), factors.join(",")]);
        }
        args
    }
}

/// Fly the job as a synthetic trainee
///
/// Connects to the vehicle over UDP like a ground station, and uses only manual control, lamp, gimbal and snapshot
/// commands. It takes off, flies the tasks in order, stops to look, photographs the defects it notices, and lands. Its
/// errors result from human numbers such as reaction delay, noise and detection sizes, which a pilot file can set.
#[derive(Debug, clap::Args)]
#[command(after_help = EXIT_CODES, after_long_help = format!("\
Examples:
  spandrel pilot --skill novice --seed 3 --connect 127.0.0.1:18570   connect to a running simulator
  spandrel pilot --skill novice --expert-in delay,noise              use the expert's delay and noise
  spandrel pilot --pilot anna.toml                                   use the numbers in a file
  spandrel pilot --port 0 --announce                                 wait for a simulator with --gcs to connect

Prints one JSON line at the end of the flight.

{EXIT_CODES}"))]
pub struct Args {
    #[command(flatten)]
    job: JobArgs,
    #[command(flatten)]
    skill: SkillArgs,
    /// Address of the vehicle
    #[arg(long, value_name = "HOST:PORT", value_parser = addresses::address, default_value = "127.0.0.1:18570")]
    connect: SocketAddr,
    /// Wait for the vehicle's first datagram on this UDP port instead of connecting to an address; 0 for any free port
    #[arg(long, value_name = "PORT", conflicts_with = "connect")]
    port: Option<u16>,
    /// Local address to bind
    #[arg(long, value_name = "ADDR", default_value = "127.0.0.1", value_parser = addresses::listen)]
    listen: IpAddr,
    /// Print one line of JSON {"port"} on standard output at startup
    #[arg(long)]
    announce: bool,
    /// Keep the link alive after the flight, and exit when standard input closes (for a parent process)
    #[arg(long)]
    leash: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// Returns an error if files or ports are invalid, the vehicle does not respond or is lost, or the flight could not
/// start.
pub fn run(args: &Args) -> Result<(), AppError> {
    let stop = StopRequest::install(args.leash)?;
    let scenario = args.job.load_scenario()?.scenario;
    let config = PilotConfig {
        seed: args.job.seed_for(&scenario),
        scenario: Arc::new(scenario),
        vehicle: Arc::new(files::vehicle(&args.job.vehicle)?.vehicle),
        skill: args.skill.skill()?,
    };
    let mut hub = SocketHub::new();
    let socket = hub.bind(args.listen, args.port.unwrap_or(0), "--port")?;
    if args.announce {
        println!("{}", json!({ "port": hub.port(socket) }));
    }
    let mut pilot = Pilot::new(config);
    let mut peer = args.port.is_none().then_some(args.connect);
    let (watch, mut last_received_at, mut reported) = (Stopwatch::start(), None, false);
    let mut progress = ProgressLog::start("waiting for the vehicle");
    while !stop.is_requested() {
        let arrival = hub.next(MAX_DATAGRAM_WAIT);
        if let Some(NetEvent::Datagram { from, bytes, .. }) = arrival
            && *peer.get_or_insert(from) == from
        {
            last_received_at = Some(watch.elapsed());
            pilot.handle_datagram(&bytes);
        }
        // If the vehicle connects first, the pilot sends nothing until then: messages timed by the wall clock would
        // differ between runs.
        if args.port.is_none() {
            pilot.handle_timeout(SimTime::from_s(watch.elapsed().as_secs_f64()));
        }
        while let Some(bytes) = pilot.poll_transmit() {
            if let Some(peer) = peer {
                hub.send(socket, peer, &bytes);
            }
        }
        progress.report(|| format!("pilot: {}", pilot.status_text()));
        if let Some(report) = pilot.finished()
            && !reported
        {
            reported = true;
            println!(
                "{}",
                json!({ "reason": report.reason, "at_s": report.at.s(), "tasks_flown": report.tasks_flown, "pictures": report.pictures,
                    "lost_s": report.lost.s() })
            );
            if !args.leash {
                break;
            }
        }
        if let Some(last) = last_received_at
            && watch.elapsed().saturating_sub(last) > SILENCE_TIMEOUT
        {
            let message = format!("no data from the vehicle for {} s", SILENCE_TIMEOUT.as_secs());
            return if reported { Ok(()) } else { Err(AppError::failed(message)) };
        }
    }
    progress.finish();
    flight_result(&pilot)
}

fn flight_result(pilot: &Pilot) -> Result<(), AppError> {
    match pilot.finished() {
        Some(report) if report.reason == "landed" => Ok(()),
        Some(report) => Err(AppError::failed(report.reason.clone())),
        None => Err(AppError::failed(format!("stopped in flight ({})", pilot.status_text()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_expert_parameters_round_trip_through_arguments() {
        let args = SkillArgs { skill: "novice".into(), pilot: None, expert_in: vec![SkillFactor::Delay, SkillFactor::Lapses] };
        assert_eq!(args.to_args(), ["--skill", "novice", "--expert-in", "delay,lapses"]);
        let skill = args.skill().unwrap();
        assert_eq!((skill.delay_s, skill.lapses_per_min), (Skill::EXPERT.delay_s, Skill::EXPERT.lapses_per_min));
        assert_eq!(skill.gain, Skill::NOVICE.gain);
        let file = SkillArgs { skill: "trained".into(), pilot: Some("anna.toml".into()), expert_in: vec![SkillFactor::Pace] };
        assert_eq!(file.to_args(), ["--pilot", "anna.toml", "--expert-in", "pace"]);
    }
}
