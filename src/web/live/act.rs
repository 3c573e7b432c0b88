//! What an instructor asks for, from the form to an order.

use super::orders::Order;
use crate::web::answer::{Answer, Answered, Refusal};
use crate::web::asked::Asked;
use crate::web::state::State;
use serde_json::json;
use spandrel_training::web::live::{self as pages, UNITS};

/// An instructor's action. It is under way when this answers; what became of it is said in the stream.
pub fn act(state: &State, asked: &Asked) -> Answered {
    let (number, live) = super::chosen(state, asked.field("vehicle"))?;
    let order = order(asked)?;
    live.orders.send(order).map_err(|_| Refusal::Failed("the live link has ended: start the server again".into()))?;
    let back = format!("/live?vehicle={number}");
    Ok(if asked.by_script { Answer::json(&json!({ "under_way": true })) } else { Answer::to(&back) })
}

fn order(asked: &Asked) -> Result<Order, Refusal> {
    match asked.needed("act")? {
        "note" => {
            let text = asked.needed("text")?;
            let count = text.chars().count();
            if count > pages::NOTE_MOST || text.chars().any(char::is_control) {
                return Err(Refusal::Wrong(format!(
                    "text: {count} characters (allowed: 1 to {}, on one line)",
                    pages::NOTE_MOST
                )));
            }
            Ok(Order::Note(text.to_owned()))
        }
        "wind" => {
            let number = |name: &str, most: f64| {
                let value: Option<f64> = asked.needed(name)?.parse().ok();
                let allowed = || Refusal::Wrong(format!("{name}: no such number (allowed: 0 to {most})"));
                value.filter(|value| (0.0..=most).contains(value)).ok_or_else(allowed)
            };
            Ok(Order::Wind { speed_m_s: number("speed", pages::WIND_MOST_M_S)?, from_deg: number("from", 360.0)? })
        }
        "traffic" => Ok(Order::Traffic { open: asked.needed("open")? == "yes" }),
        "failure" => {
            let key = asked.needed("unit")?;
            let unit = UNITS.iter().find(|(name, ..)| *name == key);
            let (_, words, unit) = unit.ok_or_else(|| Refusal::Wrong("unit: unknown".into()))?;
            Ok(Order::Failure { unit: *unit, words, fails: asked.needed("fails")? == "yes" })
        }
        _ => Err(Refusal::Wrong("act: unknown (allowed: note, wind, traffic, failure)".into())),
    }
}
