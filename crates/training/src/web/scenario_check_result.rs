//! Checks the text in the scenario editor: applies the edits, lists all problems and draws the preview.

use super::placed_defects;
use super::problem_words::ProblemWords;
use super::scenario_fields::{fields, input_texts};
use super::scenario_form::ScenarioForm;
use crate::report::plots::job::{editor_plan, editor_side, job_south};
use crate::report::plots::site_picture::site_picture;
use crate::scenario_check::{CheckOptions, Findings, ScenarioText, check_forms, check_levels, check_scenario};
use maud::{Markup, html};
use serde_json::{Value, json};
use spandrel_model::scenario::{self, Scenario, SiblingLoader};
use spandrel_model::site::Site;
use spandrel_model::toml::{Problem, split_displayed};
use spandrel_text::{Language, text};

/// Result of a check.
pub struct CheckedScenario {
    /// Text after the edits.
    pub text: String,
    /// Form; `None` if the text is not valid TOML.
    pub form: Option<ScenarioForm>,
    /// Problems, warnings and notes.
    pub findings: Findings,
    /// Drawings of the site; `None` if the scenario is invalid.
    pub preview: Option<Markup>,
    /// Message about an edit that could not be applied.
    pub rejected: Option<String>,
    /// Words about a defect that was placed, or the reason why it was not; `None` if there was none to place.
    pub placement: Option<Result<String, String>>,
}

/// Checks a text. `file` is the name in messages; `siblings` loads the files that the scenario refers to.
#[must_use]
pub fn check_text(file: &str, (text, siblings): (String, SiblingLoader), options: &CheckOptions<'_>) -> CheckedScenario {
    let language = options.language;
    let mut findings = Findings::default();
    let preview = {
        let source = ScenarioText { file, text: &text, siblings };
        match scenario::read(file, &text, siblings) {
            Ok(scenario) => {
                let preview = preview(&scenario, options, language);
                check_scenario(&source, &scenario, options, &mut findings);
                check_forms(&source, None, options, &mut findings);
                check_levels(&source, None, options, &mut findings);
                preview
            }
            Err(problems) => {
                findings.problems = problems.0;
                None
            }
        }
    };
    if !(options.may_continue)() {
        findings.warnings.push(text!(language, "editor-check-too-long", file = file));
    }
    let form = ScenarioForm::read(&text);
    CheckedScenario { text, form, findings, preview, rejected: None, placement: None }
}

fn preview(scenario: &Scenario, options: &CheckOptions<'_>, language: Language) -> Option<Markup> {
    if !(options.may_continue)() {
        return None;
    }
    let site = Site::without_defects(scenario);
    let scroll = |label: &str, drawing: &Markup| html! { div.scroll tabindex="0" role="region" aria-label=(label) { (drawing) } };
    let south = text!(language, "editor-south-caption");
    let side = |bridge: &str| text!(language, "editor-side-caption", bridge = bridge);
    let sides = scenario.bridges.iter().take_while(|_| (options.may_continue)());
    Some(html! {
        figure { (site_picture(scenario, &site, language)) figcaption { (text!(language, "editor-picture-caption")) } }
        figure data-plan data-drawing { (editor_plan(scenario, &site, language)) figcaption { (text!(language, "editor-plan-caption")) } }
        @if scenario.bridges.is_empty() {
            figure.wide { (scroll(&south, &job_south(scenario, &site, language))) figcaption { (south) } }
        }
        @for bridge in sides {
            figure.wide data-drawing=(bridge.name) {
                (scroll(&side(&bridge.name), &editor_side(scenario, &site, bridge, language)))
                figcaption { (side(&bridge.name)) }
            }
        }
    })
}

fn warning_list(language: Language, warnings: &[String]) -> Markup {
    html! { ul.warnings { @for warning in warnings { li { (text!(language, "editor-warning")) " " (warning) } } } }
}

impl CheckedScenario {
    /// Returns the answer for the page's script. `shape` is the shape of the form that the page shows.
    #[must_use]
    pub fn json(&self, language: Language, shape: &str) -> Value {
        let (shown, _) = split_displayed(&self.findings.problems);
        let problems: Vec<Value> = shown.iter().map(|problem| self.problem_json(language, problem)).collect();
        let own_shape = self.form.as_ref().map(form_shape);
        let fresh = self.form.as_ref().filter(|_| own_shape.as_deref() != Some(shape));
        json!({
            "text": self.text,
            "status": self.status(language),
            "problems": problems,
            "warnings": self.findings.warnings,
            "notes": self.findings.notes,
            "findings": self.findings_list(language).into_string(),
            "shape": own_shape,
            "form": fresh.map(|form| fields(language, form).into_string()),
            "values": self.form.as_ref().map(input_texts),
            "preview": self.preview.as_ref().map(|preview| preview.clone().into_string()),
            "rejected": self.rejected,
            "placed": placed_defects::list(language, &self.text).map(Markup::into_string),
            "placement": self.placement.as_ref().map(|placement| placement_json(language, placement)),
        })
    }

    fn problem_json(&self, language: Language, problem: &Problem) -> Value {
        let words = ProblemWords::new(language, problem);
        let element = self.form.as_ref().and_then(|form| form.element_for(problem));
        json!({
            "line": problem.line,
            "key": problem.key,
            "value": problem.value,
            "allowed": problem.allowed,
            "message": problem.message,
            "text": words.text,
            "lang": words.language.tag(),
            "element": element,
        })
    }

    /// Returns a sentence with the number of problems and warnings.
    #[must_use]
    pub fn status(&self, language: Language) -> String {
        let problems = text!(language, "editor-problem-count", count = self.findings.problems.len());
        let warnings = text!(language, "editor-warning-count", count = self.findings.warnings.len());
        match (self.findings.problems.len(), self.findings.warnings.len()) {
            (0, 0) => text!(language, "editor-problems-none"),
            (0, _) => text!(language, "editor-problems-none-warnings", warnings = warnings),
            (_, 0) => text!(language, "editor-problems-only", problems = problems),
            (_, _) => text!(language, "editor-problems-warnings", problems = problems, warnings = warnings),
        }
    }

    /// Renders the lists of problems, warnings and notes.
    #[must_use]
    pub fn findings_list(&self, language: Language) -> Markup {
        let Findings { problems, warnings, notes } = &self.findings;
        let (shown, more) = split_displayed(problems);
        html! {
            @if !problems.is_empty() {
                ul.problems {
                    @for problem in shown { li { (self.listed(language, problem)) } }
                    @if more > 0 { li { (text!(language, "editor-more-problems", count = more)) } }
                }
            }
            @match warnings.len() {
                0 => {},
                1 => (warning_list(language, warnings)),
                count => { details.warnings id="check-warnings" { summary { (text!(language, "editor-warning-count", count = count)) } (warning_list(language, warnings)) } },
            }
            @if !notes.is_empty() { details.notes id="check-notes" { summary { (text!(language, "editor-notes", count = notes.len())) } ul { @for note in notes { li { (note) } } } } }
        }
    }

    fn listed(&self, language: Language, problem: &Problem) -> Markup {
        let element = self.form.as_ref().and_then(|form| form.element_for(problem));
        let words = ProblemWords::new(language, problem);
        html! {
            @match element {
                Some(element) => a href={ "#" (element) } data-element=(element) { code { (problem.location) } },
                None => code { (problem.location) },
            }
            @if !problem.value.is_empty() { " = " (problem.value) }
            ": " span lang=[words.own_tag(language)] { (words.text) } " "
            button.line type="button" data-line=(problem.line) { (text!(language, "editor-line", line = problem.line)) }
        }
    }
}

fn placement_json(language: Language, placement: &Result<String, String>) -> Value {
    match placement {
        Ok(words) => json!({ "done": true, "text": words }),
        Err(reason) => json!({ "done": false, "text": text!(language, "placing-not-placed", reason = reason.as_str()) }),
    }
}

/// Returns a text that changes if the form has other fields or other choices.
#[must_use]
pub fn form_shape(form: &ScenarioForm) -> String {
    let fields = form.fields().map(|field| format!("{}{:?}", field.location, field.control));
    let names = form.sections.iter().flat_map(|section| &section.groups).map(|group| group.name.clone());
    let all: String = fields.chain(names).collect::<Vec<_>>().join("\n");
    spandrel_monitor::folder::sha256_hex(all.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::web::layout::tests::HOSTILE_NAME;
    use spandrel_model::elements::Element;
    use spandrel_model::mesh::Mesh;
    use spandrel_model::mesh::part_shapes::{ConcaveShape, PartShape, ShapeLimits};
    use spandrel_model::mesh::reader::ModelFormat;
    use spandrel_model::mesh::surface_mesh::SurfaceMesh;
    use spandrel_model::mesh::voxel_surface::CloudLimits;
    use spandrel_model::scenario::bridges::element_map::ElementMap;
    use spandrel_model::scenario::bridges::model::ModelPart;
    use spandrel_model::scenario::edit::{Edit, apply};
    use spandrel_model::shipped::{PHANTOM2, PRACTICE};
    use spandrel_model::site::bridge_import::{ImportOptions, ImportSource, ImportedBridge, ModelOrigin, UpAxis, import};
    use spandrel_model::site::gltf::parts_glb;
    use spandrel_model::vehicle;

    fn checked(text: &str, may_continue: &dyn Fn() -> bool) -> CheckedScenario {
        checked_in(Language::English, text, may_continue)
    }

    fn checked_in(language: Language, text: &str, may_continue: &dyn Fn() -> bool) -> CheckedScenario {
        let aircraft = vehicle::read("phantom2.toml", PHANTOM2).unwrap();
        let options = CheckOptions { aircraft: &aircraft, may_continue, language };
        check_text("practice.toml", (text.to_owned(), &|_| Err("no file".to_owned())), &options)
    }

    /// Returns an imported bridge: a block of 20 m.
    fn imported() -> ImportedBridge {
        let mesh = Mesh::of_box([-10.0, -3.0, -2.0], [10.0, 3.0, 2.0]);
        let shape = PartShape::Mesh(SurfaceMesh::with_colors(&mesh, &[]).unwrap());
        let part = ModelPart { name: "block".into(), element: Element::RcSlab, shape };
        let file = parts_glb(std::iter::once(&part)).unwrap();
        let none = |_: &str| Err("no file".to_owned());
        let (format, elements) = (ModelFormat::Gltf, ElementMap::default());
        let options = ImportOptions {
            name: "block".into(),
            scale: 1.0,
            up: UpAxis::Y,
            origin: ModelOrigin::Center,
            turn_deg: 0.0,
            default_element: None,
            limits: ShapeLimits { tolerance_m: 0.01, concave: ConcaveShape::Mesh },
            cloud: CloudLimits::default(),
        };
        import(&ImportSource { file: "block.glb", format, bytes: &file, load: &none, elements }, &options).unwrap()
    }

    #[test]
    fn exact_imported_bridge_is_drawn_and_edits_keep_its_files() {
        let bridge = imported();
        let load = |name: &str| match name {
            "bridge.glb" => Ok(bridge.model.clone()),
            "elements.toml" => Ok(bridge.elements.clone().into_bytes()),
            _ => Err("no such file".to_owned()),
        };
        let aircraft = vehicle::read("phantom2.toml", PHANTOM2).unwrap();
        let options = CheckOptions { aircraft: &aircraft, may_continue: &|| true, language: Language::English };
        let edits =
            [set("tasks[1].name", "North side"), set("bridges[0].heading_deg", "75"), Edit::Add { location: "tasks".into() }];
        let edited = apply(&bridge.scenario, &edits).unwrap();
        for text in [bridge.scenario.clone(), edited] {
            let checked = check_text("block.toml", (text.clone(), &load), &options);
            assert_eq!(checked.findings.problems, []);
            assert!(checked.preview.unwrap().into_string().contains("Side view of block"));
            assert!(text.contains("file = \"bridge.glb\"\nelements = \"elements.toml\""), "{text}");
            let form = checked.form.unwrap();
            let value = |location: &str| form.fields().find(|field| field.location == location).map(|field| field.value.as_str());
            assert_eq!(value("bridges[0].model.file"), Some("bridge.glb"));
            assert_eq!((value("tasks[0].points_relative_to"), value("bridges[0].arch.span_m")), (Some("block"), None));
        }
    }

    fn set(location: &str, text: &str) -> Edit {
        Edit::Set { location: location.into(), text: text.into() }
    }

    #[test]
    fn exact_a_valid_scenario_has_a_preview_and_notes() {
        let checked = checked(PRACTICE, &|| true);
        assert_eq!((checked.findings.problems.len(), checked.status(Language::English).as_str()), (0, "No problems."));
        let answer = checked.json(Language::English, "");
        assert_eq!(answer["text"], PRACTICE);
        assert!(answer["notes"].as_array().unwrap().len() > 2);
        let preview = answer["preview"].as_str().unwrap();
        assert!(preview.contains("data-plan") && preview.contains("image/png") && preview.contains("Side view of suspension"));
        assert!(answer["form"].is_string());
        assert!(
            checked.json(Language::English, answer["shape"].as_str().unwrap())["form"].is_null(),
            "the page has this form already"
        );
    }

    #[test]
    fn exact_problems_name_field_line_and_allowed_range() {
        let text = apply(PRACTICE, &[set("wind.from_deg", "400"), set("tasks[3].name", HOSTILE_NAME)]).unwrap();
        let checked = checked(&text, &|| true);
        let answer = checked.json(Language::English, "");
        let line = 1 + text.lines().position(|line| line.starts_with("from_deg")).unwrap();
        let problem = &answer["problems"][0];
        assert_eq!((problem["line"].as_u64(), problem["element"].as_str()), (Some(line as u64), Some("field-wind-from_deg")));
        assert_eq!(problem["text"], "out of range (allowed: 0 to 360)");
        assert!(answer["preview"].is_null() && answer["values"]["field-wind-from_deg"] == "400");
        assert!(!answer["form"].as_str().unwrap().contains("<script>"));
        assert_eq!(checked.status(Language::English), "1 problem.");
        let syntax = super::tests::checked("name = ", &|| true);
        assert!(syntax.form.is_none() && syntax.json(Language::English, "")["values"].is_null());
        let list = syntax.findings_list(Language::English).into_string();
        assert!(list.contains("data-line=\"1\"") && list.contains("syntax"), "{list}");
    }

    #[test]
    fn exact_clearance_problems_belong_to_their_task() {
        let text = PRACTICE.replace(
            "kind = \"pier_circle\"\nbridge = \"suspension\"\nstand_off_m = 4.5",
            "kind = \"free\"\npoints_m = [[0, 0, 34.5], [10, 0, 34.5]]",
        );
        let checked = checked(&text, &|| true);
        assert_eq!(
            checked.json(Language::English, "")["problems"][0]["element"],
            "field-tasks-3",
            "{:?}",
            checked.findings.problems
        );
        assert!(checked.preview.is_some(), "the preview shows the path");
    }

    #[test]
    fn exact_a_check_without_time_ends_with_a_warning() {
        let checked = checked(PRACTICE, &|| false);
        assert!(checked.preview.is_none() && checked.findings.warnings[0].contains("took too long"));
    }

    #[test]
    fn exact_several_warnings_fold_into_one_line_that_opens() {
        let mut checked = checked(PRACTICE, &|| true);
        checked.findings.warnings = vec!["the path is close to a pier".into()];
        let one = checked.findings_list(Language::English).into_string();
        assert!(
            one.contains("<ul class=\"warnings\">") && !one.contains("check-warnings"),
            "a single warning stays visible: {one}"
        );
        checked.findings.warnings.extend(["the stand-off is large".into(), "the job is long".into()]);
        let folded = checked.findings_list(Language::German).into_string();
        let start = "<details class=\"warnings\" id=\"check-warnings\"><summary>3 Warnungen</summary><ul class=\"warnings\">";
        assert!(folded.contains(start), "{folded}");
        assert_eq!(folded.matches("<li>").count() - checked.findings.notes.len(), 3, "{folded}");
    }

    #[test]
    fn exact_sentences_around_messages_are_translated() {
        let text = apply(PRACTICE, &[set("wind.from_deg", "400")]).unwrap();
        let wrong = checked(&text, &|| true);
        assert_eq!(wrong.status(Language::German), "1 Problem.");
        let list = wrong.findings_list(Language::German).into_string();
        assert!(list.contains("<span>außerhalb des Bereichs (zulässig: 0 bis 360)</span>") && list.contains(">Zeile "), "{list}");
        assert_eq!(checked(PRACTICE, &|| true).status(Language::Spanish), "Sin problemas.");
        let stopped = checked(PRACTICE, &|| false);
        assert_eq!(stopped.status(Language::English), "No problems, 1 warning.");
        assert_eq!(stopped.status(Language::German), "Keine Probleme, 1 Warnung.");
    }

    #[test]
    fn exact_warnings_and_notes_are_in_the_language_of_the_page() {
        let text = PRACTICE.replacen("[rules]", "[rules]\nbattery_temperature_c = 5", 1);
        let [english, german, spanish] = Language::ALL.map(|language| checked_in(language, &text, &|| true).findings);
        assert!(english.problems.is_empty() && !english.warnings.is_empty() && english.notes.len() > 5, "{english:?}");
        let all = |findings: &Findings| [findings.warnings.clone(), findings.notes.clone()].concat();
        for ((english, german), spanish) in all(&english).iter().zip(&all(&german)).zip(&all(&spanish)) {
            assert!(english != german && english != spanish && german != spanish, "{english}\n{german}\n{spanish}");
        }
    }
}
