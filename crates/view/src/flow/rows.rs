//! Menu rows of each page.

use super::menu::{MenuAction, MenuRow};
use super::{Page, WindowFlow, briefing, school, summary, tutorial};

impl WindowFlow {
    /// Returns the menu rows of the current page.
    #[must_use]
    pub fn rows(&self) -> Vec<MenuRow> {
        match self.page {
            Page::Opening | Page::Waiting | Page::Flight => Vec::new(),
            Page::Start => self.start_rows(),
            Page::Controls => self.controls_rows(),
            Page::Calibrating => {
                vec![
                    MenuRow::button(MenuAction::Confirm, "Continue (Enter)"),
                    MenuRow::button(MenuAction::Cancel, "Cancel (Esc)"),
                ]
            }
            Page::Tutorial(page, flight) => tutorial_rows(page, flight),
            Page::Settings { .. } => self.settings_rows(),
            Page::Keys { .. } => self.key_rows(),
            Page::Briefing => briefing::rows(),
            Page::Paused => vec![
                MenuRow::button(MenuAction::Resume, "Resume (Esc)"),
                MenuRow::button(MenuAction::Restart, "Restart"),
                MenuRow::button(MenuAction::Settings, "Settings and keys"),
                MenuRow::button(MenuAction::End, "End session"),
            ],
            Page::ConfirmEnd => {
                vec![
                    MenuRow::button(MenuAction::KeepFlying, "Keep flying (Esc)"),
                    MenuRow::button(MenuAction::End, "End and score flight"),
                ]
            }
            Page::Results => summary::rows(self.ended.as_ref()),
            Page::School => self.school.as_ref().map(school::rows).unwrap_or_default(),
        }
    }

    fn start_rows(&self) -> Vec<MenuRow> {
        let title = self.chosen_job().map_or(self.choice.scenario.as_str(), |job| job.title.as_str());
        let next = self.next_job().map(|next| MenuRow::button(MenuAction::FlyNext, next.words()));
        let rows = [
            MenuRow::text_field(MenuAction::Trainee, "Trainee", self.choice.trainee.clone()),
            MenuRow::choice(MenuAction::Scenario, "Job", title),
            MenuRow::choice(MenuAction::Purpose, "Purpose", self.choice.purpose.word()),
            MenuRow::button(MenuAction::CheckController, "Next: check controller"),
            MenuRow::button(MenuAction::WatchExpert, "Watch an expert fly this job"),
            MenuRow::button(MenuAction::OpenTutorial, "Read the tutorial"),
            MenuRow::button(MenuAction::School, "Defect school: recognize defects in pictures"),
            MenuRow::button(MenuAction::Settings, "Settings: keys, units, text size, sound"),
            MenuRow::button(MenuAction::Quit, "Quit"),
        ];
        // The trainee comes first, because the recommendation depends on it.
        let (who, rest) = rows.split_at(1);
        who.iter().cloned().chain(next).chain(rest.iter().cloned()).collect()
    }

    fn controls_rows(&self) -> Vec<MenuRow> {
        let controls = &self.controls;
        let mut rows = vec![MenuRow::button(MenuAction::Fly, "Start flight")];
        if controls.is_connected() {
            rows.push(MenuRow::button(MenuAction::Calibrate, if controls.calibrated { "Calibrate again" } else { "Calibrate" }));
            rows.push(MenuRow::choice(MenuAction::Mode, "Stick mode", controls.mode.to_string()));
        } else {
            rows.push(MenuRow::button(MenuAction::FindController, "Search for controller"));
        }
        if controls.is_connected() && controls.calibrated {
            rows.push(MenuRow::choice(MenuAction::DeadBand, "Dead band", format!("{:.0}%", 100.0 * controls.dead_band)));
            rows.push(MenuRow::choice(MenuAction::Expo, "Expo", format!("{:.1}", controls.expo)));
        }
        rows.push(MenuRow::button(MenuAction::Back, "Back (Esc)"));
        rows
    }
}

fn tutorial_rows(page: usize, flight: bool) -> Vec<MenuRow> {
    let last = page + 1 == tutorial::PAGE_COUNT;
    let next = match (last, flight) {
        (false, _) => "Next page",
        (true, true) => "Fly",
        (true, false) => "Done",
    };
    let mut rows = vec![MenuRow::button(MenuAction::Next, next)];
    rows.push(MenuRow::button(MenuAction::Back, "Back (Esc)"));
    if !last {
        rows.push(MenuRow::button(MenuAction::Skip, if flight { "Skip and fly" } else { "Skip" }));
    }
    rows
}
