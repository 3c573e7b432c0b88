//! What keys and clicks do on a page.

use super::menu::{Deed, Kind, Row};
use super::pipe::{Ended, FromWindow, Offers, Purpose};
use super::{Controls, Flow, Order, Page, Press, Tune, tutorial};

/// Most signs of a pseudonym, as everywhere.
const NAME_MAX: usize = 32;
const READY: &str = "The simulator gets ready ...";
/// Steps of dead band and expo.
const FINE: f64 = 0.01;
const COARSE: f64 = 0.1;

impl Flow {
    /// A key or a click on a page.
    pub fn press(&mut self, press: Press) {
        self.words = None;
        let rows = self.rows();
        let last = rows.len().saturating_sub(1);
        let kind = rows.get(self.focus).map(|row| row.kind);
        match press {
            Press::Up => self.focus = if self.focus == 0 { last } else { self.focus - 1 },
            Press::Down => self.focus = if self.focus >= last { 0 } else { self.focus + 1 },
            // A page may come under a key that flies: left and right change values, and nothing else.
            Press::Left | Press::Right if kind == Some(Kind::Button) => {}
            Press::Left => self.step(&rows, false),
            Press::Right => self.step(&rows, true),
            Press::Enter => self.activate(&rows),
            Press::Escape => self.back(),
            Press::Backspace if kind == Some(Kind::Typed) => {
                self.choice.trainee.pop();
            }
            Press::Sign(sign) if kind == Some(Kind::Typed) => self.typed(sign),
            Press::Backspace | Press::Sign(_) => {}
            Press::Row(row) if row < rows.len() => {
                self.focus = row;
                if rows[row].kind == Kind::Button {
                    self.activate(&rows);
                }
            }
            Press::Step(row, on) if row < rows.len() => {
                self.focus = row;
                self.step(&rows, on);
            }
            Press::Row(_) | Press::Step(..) => {}
        }
    }

    fn typed(&mut self, sign: char) {
        let fits = sign.is_ascii_alphanumeric() || (!self.choice.trainee.is_empty() && (sign == '-' || sign == '_'));
        if !fits {
            self.words = Some("A pseudonym has letters, digits, '-' and '_', and begins with a letter or a digit.".into());
        } else if self.choice.trainee.len() >= NAME_MAX {
            self.words = Some(format!("A pseudonym has at most {NAME_MAX} signs."));
        } else {
            self.choice.trainee.push(sign);
        }
    }

    fn step(&mut self, rows: &[Row], on: bool) {
        let Some(row) = rows.get(self.focus) else { return };
        let way = if on { 1.0 } else { -1.0 };
        let Controls { mode, dead_band, expo, .. } = self.controls;
        match row.deed {
            Deed::Trainee => self.next_trainee(on),
            Deed::Scenario => self.next_scenario(on),
            Deed::Purpose => {
                self.choice.purpose = match self.choice.purpose {
                    Purpose::Practice => Purpose::Assessment,
                    Purpose::Assessment => Purpose::Practice,
                };
            }
            Deed::Mode => {
                let mode = (mode - 1 + if on { 1 } else { 3 }) % 4 + 1;
                self.out.push_back(Order::Tune(Tune::Mode(mode)));
            }
            Deed::DeadBand => {
                let dead_band = (dead_band + FINE * way).clamp(0.0, 0.5);
                self.out.push_back(Order::Tune(Tune::DeadBand(dead_band)));
            }
            Deed::Expo => {
                let expo = (expo + COARSE * way).clamp(0.0, 1.0);
                self.out.push_back(Order::Tune(Tune::Expo(expo)));
            }
            _ => {}
        }
    }

    fn next_trainee(&mut self, on: bool) {
        let Some(offers) = &self.offers else { return };
        let names: Vec<&str> = offers.trainees.iter().map(|person| person.name.as_str()).collect();
        if let Some(name) = neighbour(&names, &self.choice.trainee, on) {
            self.choice.trainee = name.to_owned();
        }
    }

    fn next_scenario(&mut self, on: bool) {
        let Some(offers) = &self.offers else { return };
        let names: Vec<&str> = offers.scenarios.iter().map(|job| job.name.as_str()).collect();
        if let Some(name) = neighbour(&names, &self.choice.scenario, on) {
            self.choice.scenario = name.to_owned();
        }
    }

    /// Whoever has flown no practice here yet reads the tutorial before the first one.
    pub(super) fn is_new(&self) -> bool {
        let flown = |offers: &Offers| offers.trainees.iter().any(|p| p.name == self.choice.trainee && p.practices > 0);
        !self.taught.contains(&self.choice.trainee) && !self.offers.as_ref().is_some_and(flown)
    }

    fn activate(&mut self, rows: &[Row]) {
        let Some(row) = rows.get(self.focus) else { return };
        match row.deed {
            Deed::Trainee | Deed::Scenario | Deed::Purpose | Deed::Mode | Deed::DeadBand | Deed::Expo => {
                self.focus = (self.focus + 1).min(rows.len().saturating_sub(1));
            }
            Deed::Check if self.choice.trainee.is_empty() => self.words = Some("Type a pseudonym first.".into()),
            Deed::Check => self.go(Page::Controls),
            Deed::Learn => self.go(Page::Tutorial(0, false)),
            Deed::Sound => self.toggle_sound(),
            Deed::Look => self.out.push_back(Order::Look),
            Deed::Calibrate => self.out.push_back(Order::Calibrate),
            Deed::Fly if self.choice.purpose == Purpose::Practice && self.is_new() => self.go(Page::Tutorial(0, true)),
            Deed::Fly => self.choose(),
            Deed::Back => self.back(),
            Deed::Next => self.turn(),
            Deed::Skip => self.taught_enough(),
            Deed::Confirm => self.out.push_back(Order::Confirm),
            Deed::Cancel => self.out.push_back(Order::Cancel),
            Deed::Stay => self.go(Page::Flight),
            Deed::Resume => self.tell(FromWindow::Resume),
            Deed::Restart => {
                self.leave(READY);
                self.tell(FromWindow::Restart);
            }
            Deed::End => {
                self.leave("The flight is scored ...");
                self.tell(FromWindow::End);
            }
            Deed::Again => {
                self.leave(READY);
                self.tell(FromWindow::Again);
            }
            Deed::Other => self.go(Page::Start),
            Deed::Report => self.open(|ended| ended.report.clone()),
            Deed::Questions => self.open(|ended| Some(ended.questionnaire.clone())),
            Deed::Quit => {
                self.tell(FromWindow::Quit);
                self.out.push_back(Order::Close);
            }
        }
    }

    /// The simulator works at what comes next.
    fn leave(&mut self, awaited: &'static str) {
        self.out.push_back(Order::Land);
        self.wait(awaited);
    }

    fn wait(&mut self, awaited: &'static str) {
        self.awaited = awaited;
        self.go(Page::Waiting);
    }

    fn choose(&mut self) {
        self.tell(FromWindow::Chosen(self.choice.clone()));
        self.wait(READY);
    }

    fn turn(&mut self) {
        if let Page::Tutorial(page, flight) = self.page {
            if page + 1 < tutorial::PAGES {
                self.go(Page::Tutorial(page + 1, flight));
            } else {
                self.taught_enough();
            }
        }
    }

    fn taught_enough(&mut self) {
        self.taught.insert(self.choice.trainee.clone());
        match self.page {
            Page::Tutorial(_, true) => self.choose(),
            _ => self.go(Page::Start),
        }
    }

    fn open(&mut self, address: impl Fn(&Ended) -> Option<String>) {
        if let Some(address) = self.ended.as_ref().and_then(address) {
            self.out.push_back(Order::Open(address));
        }
    }

    fn back(&mut self) {
        match self.page {
            Page::Controls | Page::Tutorial(0, false) => self.go(Page::Start),
            Page::Tutorial(0, true) => self.go(Page::Controls),
            Page::Tutorial(page, flight) => self.go(Page::Tutorial(page - 1, flight)),
            Page::Calibrating => self.out.push_back(Order::Cancel),
            Page::Paused => self.tell(FromWindow::Resume),
            Page::Leaving => self.go(Page::Flight),
            Page::Opening | Page::Start | Page::Waiting | Page::Flight | Page::Over => {}
        }
    }
}

/// The name beside this one, round the end; the first for a name that is not among them.
fn neighbour<'a>(names: &[&'a str], name: &str, on: bool) -> Option<&'a str> {
    let count = names.len();
    let at = names.iter().position(|known| *known == name);
    let next = match (at, on) {
        (None, _) => 0,
        (Some(at), true) => (at + 1) % count,
        (Some(at), false) => (at + count - 1) % count,
    };
    names.get(next).copied()
}
