//! What happens when sticks, ground station or battery fail.

use super::pilot::{Autopilot, Severity};
use super::{Landed, LinkLoss, Mode};
use crate::base::time::SimTime;

impl Autopilot {
    pub(super) fn failsafes(&mut self, now: SimTime) {
        if self.landed == Landed::OnGround {
            return;
        }
        self.lost_sticks(now);
        self.lost_link(now);
        self.low_battery();
    }

    fn lost_sticks(&mut self, now: SimTime) {
        let by_hand = matches!(self.mode, Mode::Stabilized | Mode::Altitude | Mode::Position);
        if by_hand && self.fresh_sticks(now).is_none() {
            self.act(self.tuning.manual_loss, "manual control lost");
        }
    }

    fn lost_link(&mut self, now: SimTime) {
        let lost = self.link_heard.is_some_and(|at| (now - at).s() > self.tuning.data_link_loss_s);
        let automatic = matches!(self.mode, Mode::Hold | Mode::Mission | Mode::Takeoff);
        if lost && automatic && self.tuning.data_link_loss != LinkLoss::Ignore && self.failsafe.is_none() {
            self.act(self.tuning.data_link_loss, "ground station lost");
        }
    }

    fn low_battery(&mut self) {
        let (low, critical) = (self.rules.low_battery_pct, self.rules.critical_battery_pct);
        if self.battery_pct <= critical && self.low_battery_told < 2 {
            self.low_battery_told = 2;
            self.tell(Severity::Critical, format!("Battery critical: {:.0} %", self.battery_pct));
            if self.rules.low_battery_return {
                self.act(LinkLoss::Land, "battery critical");
            }
        } else if self.battery_pct <= low && self.low_battery_told < 1 {
            self.low_battery_told = 1;
            self.tell(Severity::Warning, format!("Battery low: {:.0} %", self.battery_pct));
            if self.rules.low_battery_return {
                self.act(LinkLoss::Return, "battery low");
            }
        }
    }

    fn act(&mut self, action: LinkLoss, why: &str) {
        let mode = match action {
            LinkLoss::Ignore => return,
            LinkLoss::Hold => Mode::Hold,
            LinkLoss::Return => Mode::Return,
            LinkLoss::Land => Mode::Land,
        };
        self.enter(mode);
        self.failsafe = Some(why.to_string());
        self.tell(Severity::Critical, format!("Failsafe: {why}"));
    }
}
