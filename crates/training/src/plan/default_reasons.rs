//! Reasons of the default rules in the language of a page. Rules files contain one language; a rule whose reason is the default one
//! is translated by its name.

use spandrel_text::{Language, text};

/// Values in a reason, as text.
#[derive(Debug, Clone, Default)]
pub(super) struct ReasonValues {
    /// Name of the task, or the number of tasks.
    pub task: String,
    /// Measured value.
    pub value: String,
    /// Direction off the path.
    pub axis: String,
    /// Maximum speed.
    pub fastest: String,
    /// Missed defects.
    pub defects: String,
}

/// Returns the reason of the default rule with this name; `None` if there is no such rule.
pub(super) fn default_reason(rule: &str, values: &ReasonValues, language: Language) -> Option<String> {
    let ReasonValues { task, value, axis, fastest, defects } = values;
    Some(match rule {
        "hit a person" => text!(language, "plan-reason-hit-a-person"),
        "hit a vehicle" => text!(language, "plan-reason-hit-a-vehicle"),
        "too fast everywhere" => text!(language, "plan-reason-too-fast-everywhere", task = task.as_str()),
        "too fast along the slab" => text!(
            language,
            "plan-reason-too-fast-along-the-slab",
            fastest = fastest.as_str(),
            task = task.as_str(),
            value = value.as_str()
        ),
        "too fast under the arch" => text!(
            language,
            "plan-reason-too-fast-under-the-arch",
            fastest = fastest.as_str(),
            task = task.as_str(),
            value = value.as_str()
        ),
        "too fast in the interlayer" => text!(
            language,
            "plan-reason-too-fast-in-the-interlayer",
            fastest = fastest.as_str(),
            task = task.as_str(),
            value = value.as_str()
        ),
        "too fast around the pier" => text!(
            language,
            "plan-reason-too-fast-around-the-pier",
            fastest = fastest.as_str(),
            task = task.as_str(),
            value = value.as_str()
        ),
        "unsteady heading" => text!(language, "plan-reason-unsteady-heading", task = task.as_str(), value = value.as_str()),
        "unsteady sticks" => text!(language, "plan-reason-unsteady-sticks", task = task.as_str(), value = value.as_str()),
        "too far from the surface" => {
            text!(language, "plan-reason-too-far-from-the-surface", task = task.as_str(), value = value.as_str())
        }
        "too close to the surface" => {
            text!(language, "plan-reason-too-close-to-the-surface", task = task.as_str(), value = value.as_str())
        }
        "too far in one task" => text!(language, "plan-reason-too-far-in-one-task", task = task.as_str(), value = value.as_str()),
        "too close in one task" => {
            text!(language, "plan-reason-too-close-in-one-task", task = task.as_str(), value = value.as_str())
        }
        "too low" => text!(language, "plan-reason-too-low", task = task.as_str(), value = value.as_str()),
        "too high" => text!(language, "plan-reason-too-high", task = task.as_str(), value = value.as_str()),
        "low clearance" => text!(language, "plan-reason-low-clearance", task = task.as_str(), value = value.as_str()),
        "long exposure" => text!(language, "plan-reason-long-exposure", value = value.as_str()),
        "off the path in several tasks" => text!(language, "plan-reason-off-the-path-in-several-tasks", task = task.as_str()),
        "off the slab path" => {
            text!(language, "plan-reason-off-the-slab-path", axis = axis.as_str(), task = task.as_str(), value = value.as_str())
        }
        "off the arch path" => {
            text!(language, "plan-reason-off-the-arch-path", axis = axis.as_str(), task = task.as_str(), value = value.as_str())
        }
        "off the interlayer path" => text!(
            language,
            "plan-reason-off-the-interlayer-path",
            axis = axis.as_str(),
            task = task.as_str(),
            value = value.as_str()
        ),
        "off the pier circle" => {
            text!(language, "plan-reason-off-the-pier-circle", axis = axis.as_str(), task = task.as_str(), value = value.as_str())
        }
        "off a drill path" => {
            text!(language, "plan-reason-off-a-drill-path", axis = axis.as_str(), task = task.as_str(), value = value.as_str())
        }
        "beside the path in several tasks" => {
            text!(language, "plan-reason-beside-the-path-in-several-tasks", task = task.as_str())
        }
        "beside the slab path" => {
            text!(language, "plan-reason-beside-the-slab-path", task = task.as_str(), value = value.as_str())
        }
        "beside the arch path" => {
            text!(language, "plan-reason-beside-the-arch-path", task = task.as_str(), value = value.as_str())
        }
        "beside the interlayer path" => {
            text!(language, "plan-reason-beside-the-interlayer-path", task = task.as_str(), value = value.as_str())
        }
        "beside the pier circle" => {
            text!(language, "plan-reason-beside-the-pier-circle", task = task.as_str(), value = value.as_str())
        }
        "poor altitude hold" => text!(language, "plan-reason-poor-altitude-hold", task = task.as_str(), value = value.as_str()),
        "crashes in several tasks" => text!(language, "plan-reason-crashes-in-several-tasks", task = task.as_str()),
        "crashes along the slab" => {
            text!(language, "plan-reason-crashes-along-the-slab", task = task.as_str(), value = value.as_str())
        }
        "crashes under the arch" => {
            text!(language, "plan-reason-crashes-under-the-arch", task = task.as_str(), value = value.as_str())
        }
        "crashes in the interlayer" => {
            text!(language, "plan-reason-crashes-in-the-interlayer", task = task.as_str(), value = value.as_str())
        }
        "crashes at the pier" => text!(language, "plan-reason-crashes-at-the-pier", task = task.as_str(), value = value.as_str()),
        "crashes between the tasks" => text!(language, "plan-reason-crashes-between-the-tasks", value = value.as_str()),
        "crashes into ground" => text!(language, "plan-reason-crashes-into-ground", value = value.as_str()),
        "crashes into water" => text!(language, "plan-reason-crashes-into-water", value = value.as_str()),
        "several tasks not attempted" => text!(language, "plan-reason-several-tasks-not-attempted", task = task.as_str()),
        "several paths partly flown" => text!(language, "plan-reason-several-paths-partly-flown", task = task.as_str()),
        "slab not attempted" => text!(language, "plan-reason-slab-not-attempted", task = task.as_str()),
        "slab partly flown" => text!(language, "plan-reason-slab-partly-flown", task = task.as_str(), value = value.as_str()),
        "arch not attempted" => text!(language, "plan-reason-arch-not-attempted", task = task.as_str()),
        "arch partly flown" => text!(language, "plan-reason-arch-partly-flown", task = task.as_str(), value = value.as_str()),
        "interlayer not attempted" => text!(language, "plan-reason-interlayer-not-attempted", task = task.as_str()),
        "interlayer partly flown" => {
            text!(language, "plan-reason-interlayer-partly-flown", task = task.as_str(), value = value.as_str())
        }
        "pier not attempted" => text!(language, "plan-reason-pier-not-attempted", task = task.as_str()),
        "pier partly flown" => text!(language, "plan-reason-pier-partly-flown", task = task.as_str(), value = value.as_str()),
        "lamp off" => text!(language, "plan-reason-lamp-off", task = task.as_str(), value = value.as_str()),
        "poor framing in several tasks" => text!(language, "plan-reason-poor-framing-in-several-tasks", task = task.as_str()),
        "poor framing" => text!(language, "plan-reason-poor-framing", task = task.as_str(), value = value.as_str()),
        "no pictures" => text!(language, "plan-reason-no-pictures"),
        "hidden defects missed" => text!(language, "plan-reason-hidden-defects-missed", value = value.as_str()),
        "fine cracks missed" => text!(language, "plan-reason-fine-cracks-missed", value = value.as_str()),
        "defects missed" => text!(language, "plan-reason-defects-missed", value = value.as_str()),
        "severe defects missed" => text!(language, "plan-reason-severe-defects-missed", defects = defects.as_str()),
        "missed in plain view" => {
            text!(language, "plan-reason-missed-in-plain-view", defects = defects.as_str(), value = value.as_str())
        }
        "pictures too dark" => text!(language, "plan-reason-pictures-too-dark", value = value.as_str()),
        "pictures too oblique" => text!(language, "plan-reason-pictures-too-oblique", value = value.as_str()),
        "pictures from too far" => text!(language, "plan-reason-pictures-from-too-far", value = value.as_str()),
        "lines too thin in pictures" => text!(language, "plan-reason-lines-too-thin-in-pictures", value = value.as_str()),
        "blurred pictures" => text!(language, "plan-reason-blurred-pictures", value = value.as_str()),
        "coarse pictures" => text!(language, "plan-reason-coarse-pictures", value = value.as_str()),
        "oblique pictures" => text!(language, "plan-reason-oblique-pictures", value = value.as_str()),
        "pictures of nothing" => text!(language, "plan-reason-pictures-of-nothing", value = value.as_str()),
        "battery empty" => text!(language, "plan-reason-battery-empty"),
        "took too long" => text!(language, "plan-reason-took-too-long", value = value.as_str()),
        "did not return to the pad" => text!(language, "plan-reason-did-not-return-to-the-pad"),
        "landed with little battery" => text!(language, "plan-reason-landed-with-little-battery"),
        _ => return None,
    })
}
