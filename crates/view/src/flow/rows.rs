//! Which rows a page has.

use super::menu::{Deed, Row};
use super::{Flow, Page, over, tutorial};

impl Flow {
    /// What can be done on this page.
    #[must_use]
    pub fn rows(&self) -> Vec<Row> {
        match self.page {
            Page::Opening | Page::Waiting | Page::Flight => Vec::new(),
            Page::Start => self.start_rows(),
            Page::Controls => self.controls_rows(),
            Page::Calibrating => vec![Row::button(Deed::Confirm, "Go on (Enter)"), Row::button(Deed::Cancel, "Leave (Esc)")],
            Page::Tutorial(page, flight) => tutorial_rows(page, flight),
            Page::Paused => vec![
                Row::button(Deed::Resume, "Fly on (Esc)"),
                Row::button(Deed::Restart, "End this attempt, begin anew"),
                Row::button(Deed::End, "End the session"),
            ],
            Page::Leaving => {
                vec![Row::button(Deed::Stay, "Fly on (Esc)"), Row::button(Deed::End, "End it: score what was flown")]
            }
            Page::Over => over::rows(self.ended.as_ref()),
        }
    }

    fn start_rows(&self) -> Vec<Row> {
        let job = self.offers.as_ref().and_then(|offers| offers.scenarios.iter().find(|job| job.name == self.choice.scenario));
        let title = job.map_or(self.choice.scenario.as_str(), |job| job.title.as_str());
        vec![
            Row::typed(Deed::Trainee, "Trainee", self.choice.trainee.clone()),
            Row::choice(Deed::Scenario, "Job", title),
            Row::choice(Deed::Purpose, "Purpose", self.choice.purpose.word()),
            Row::button(Deed::Check, "Go on: check the controller"),
            Row::button(Deed::Learn, "Read the tutorial"),
            Row::button(Deed::Sound, if self.sound { "Sound is on" } else { "Sound is off" }),
            Row::button(Deed::Quit, "Quit"),
        ]
    }

    fn controls_rows(&self) -> Vec<Row> {
        let controls = &self.controls;
        let mut rows = vec![Row::button(Deed::Fly, "Go on: fly")];
        if controls.is_there() {
            rows.push(Row::button(Deed::Calibrate, if controls.calibrated { "Calibrate again" } else { "Calibrate" }));
            rows.push(Row::choice(Deed::Mode, "Stick mode", controls.mode.to_string()));
        } else {
            rows.push(Row::button(Deed::Look, "Look for a controller again"));
        }
        if controls.is_there() && controls.calibrated {
            rows.push(Row::choice(Deed::DeadBand, "Dead band", format!("{:.0} %", 100.0 * controls.dead_band)));
            rows.push(Row::choice(Deed::Expo, "Expo", format!("{:.1}", controls.expo)));
        }
        rows.push(Row::button(Deed::Back, "Back (Esc)"));
        rows
    }
}

fn tutorial_rows(page: usize, flight: bool) -> Vec<Row> {
    let last = page + 1 == tutorial::PAGES;
    let next = match (last, flight) {
        (false, _) => "Next page",
        (true, true) => "Fly",
        (true, false) => "Done",
    };
    let mut rows = vec![Row::button(Deed::Next, next)];
    rows.push(Row::button(Deed::Back, "Back (Esc)"));
    if !last {
        rows.push(Row::button(Deed::Skip, if flight { "Skip, fly" } else { "Skip" }));
    }
    rows
}
