//! Menu rows of each page.

use super::menu::{MenuAction, MenuRow};
use super::settings_page::quality_title;
use super::{Page, Setting, WindowFlow, briefing, school, summary, tutorial};
use spandrel_text::{Language, text};

impl WindowFlow {
    /// Returns the menu rows of the current page.
    #[must_use]
    pub fn rows(&self) -> Vec<MenuRow> {
        let language = self.language();
        match self.page {
            Page::Opening | Page::Waiting | Page::Flight => Vec::new(),
            Page::Start => self.start_rows(),
            Page::Controls => self.controls_rows(),
            Page::Calibrating => {
                vec![
                    MenuRow::button(MenuAction::Confirm, text!(language, "window-controls-continue")),
                    MenuRow::button(MenuAction::Cancel, text!(language, "window-controls-cancel")),
                ]
            }
            Page::Tutorial(page, flight) => tutorial_rows(page, flight, language),
            Page::Settings { .. } => self.settings_rows(),
            Page::Keys { .. } => self.key_rows(),
            Page::Briefing if self.is_briefing_current() => briefing::rows(language),
            Page::Briefing => vec![MenuRow::button(MenuAction::Back, text!(language, "window-back"))],
            Page::Paused => vec![
                MenuRow::button(MenuAction::Resume, text!(language, "window-paused-resume")),
                MenuRow::button(MenuAction::Restart, self.restart_label()),
                MenuRow::button(MenuAction::Settings, text!(language, "window-paused-settings")),
                MenuRow::button(MenuAction::End, self.end_label()),
            ],
            Page::ConfirmEnd => {
                vec![
                    MenuRow::button(MenuAction::KeepFlying, text!(language, "window-paused-keep-flying")),
                    MenuRow::button(MenuAction::End, text!(language, "window-paused-score")),
                ]
            }
            Page::Results => summary::rows(self.ended.as_ref(), self.moment, language),
            Page::School => self.school.as_ref().map(|shown| school::rows(shown, language)).unwrap_or_default(),
        }
    }

    fn restart_label(&self) -> String {
        if self.confirming == Some(MenuAction::Restart) {
            text!(self.language(), "window-paused-restart-again")
        } else {
            text!(self.language(), "window-paused-restart")
        }
    }

    fn end_label(&self) -> String {
        if self.confirming == Some(MenuAction::End) {
            text!(self.language(), "window-paused-end-again")
        } else {
            text!(self.language(), "window-paused-end")
        }
    }

    fn start_rows(&self) -> Vec<MenuRow> {
        let language = self.language();
        let title = self.chosen_job().map_or(self.choice.scenario.as_str(), |job| job.title.as_str());
        let next = self.next_job().map(|next| MenuRow::button(MenuAction::FlyNext, next.words(language)));
        let mut rows = vec![
            MenuRow::text_field(MenuAction::Trainee, text!(language, "window-start-trainee"), self.choice.trainee.clone()),
            MenuRow::choice(MenuAction::Scenario, text!(language, "window-start-job"), title),
            MenuRow::choice(MenuAction::Purpose, text!(language, "window-start-purpose"), self.choice.purpose.title(language)),
            MenuRow::button(MenuAction::CheckController, text!(language, "window-start-check-controller")),
            MenuRow::button(MenuAction::WatchExpert, text!(language, "window-start-watch-expert")),
            MenuRow::button(MenuAction::OpenTutorial, text!(language, "window-start-tutorial")),
            MenuRow::button(MenuAction::School, text!(language, "window-start-school")),
            MenuRow::button(MenuAction::Settings, text!(language, "window-start-settings")),
            MenuRow::choice(MenuAction::Setting(Setting::Language), text!(language, "window-language"), language.name()),
            MenuRow::choice(
                MenuAction::Setting(Setting::Quality),
                text!(language, "window-settings-picture"),
                quality_title(self.settings.quality, language),
            ),
            MenuRow::button(MenuAction::Quit, text!(language, "window-start-quit")),
        ];
        // Below the job; the recommendation follows the trainee, on whom it depends.
        rows.splice(2..2, self.aircraft_row());
        rows.splice(1..1, next);
        rows
    }

    /// Returns the choice of the aircraft, if there are any to choose from.
    fn aircraft_row(&self) -> Option<MenuRow> {
        let vehicles = &self.offers.as_ref()?.vehicles;
        let selected = vehicles.iter().find(|offer| offer.name == self.choice.vehicle);
        let title = selected.map_or(self.choice.vehicle.as_str(), |offer| offer.title.as_str());
        let label = text!(self.language(), "window-start-aircraft");
        (!vehicles.is_empty()).then(|| MenuRow::choice(MenuAction::Aircraft, label, title))
    }

    fn controls_rows(&self) -> Vec<MenuRow> {
        let (controls, language) = (&self.controls, self.language());
        let mut rows = vec![MenuRow::button(MenuAction::Fly, text!(language, "window-controls-fly"))];
        if controls.is_connected() {
            let calibrate = if controls.calibrated {
                text!(language, "window-controls-calibrate-again")
            } else {
                text!(language, "window-controls-calibrate")
            };
            rows.push(MenuRow::button(MenuAction::Calibrate, calibrate));
            rows.push(MenuRow::choice(MenuAction::Mode, text!(language, "window-controls-mode"), controls.mode.to_string()));
        } else {
            rows.push(MenuRow::button(MenuAction::FindController, text!(language, "window-controls-search")));
        }
        if controls.is_connected() && controls.calibrated {
            let dead_band = format!("{:.0}%", 100.0 * controls.dead_band);
            rows.push(MenuRow::choice(MenuAction::DeadBand, text!(language, "window-controls-dead-band"), dead_band));
            rows.push(MenuRow::choice(
                MenuAction::Expo,
                text!(language, "window-controls-expo"),
                format!("{:.1}", controls.expo),
            ));
        }
        rows.push(MenuRow::button(MenuAction::Back, text!(language, "window-back")));
        rows
    }
}

fn tutorial_rows(page: usize, flight: bool, language: Language) -> Vec<MenuRow> {
    let last = page + 1 == tutorial::PAGE_COUNT;
    let next = match (last, flight) {
        (false, _) => text!(language, "tutorial-next"),
        (true, true) => text!(language, "tutorial-fly"),
        (true, false) => text!(language, "tutorial-done"),
    };
    let mut rows = vec![MenuRow::button(MenuAction::Next, next)];
    rows.push(MenuRow::button(MenuAction::Back, text!(language, "window-back")));
    if !last {
        let skip = if flight { text!(language, "tutorial-skip-and-fly") } else { text!(language, "tutorial-skip") };
        rows.push(MenuRow::button(MenuAction::Skip, skip));
    }
    rows
}
