//! Session-specific content of a site: traffic and crew, defects, light. Queries take the result for static geometry as
//! an argument, which makes them independent of its implementation.

use super::camera_pose::CameraPose;
use super::defects::{self, PlacementContext};
use super::drones::SiteDrones;
use super::light::{LightModel, RayCast};
use super::query_types::{NearestPoint, QueryTime, RayHit};
use super::ropes::SiteRopes;
use super::traffic::TrafficPlan;
use super::visibility::{self, DefectView};
use crate::frames::{Enu, Vec3};
use crate::scenario::bridges::{Lane, Member};
use crate::scenario::{PlacedDefect, Scenario};
use crate::time::SimTime;
use crate::vehicle::{Camera, Lamp};

/// Traffic plan, defects and light of one session. Plain data, immutable after construction.
#[derive(Debug, Clone, PartialEq)]
pub struct Dynamics {
    /// Plan of cars, trucks and pedestrians, the crew, and drones that fly along paths.
    pub traffic: TrafficPlan,
    /// Model of sun, sky and reflections.
    pub light: LightModel,
    /// The session's defects.
    pub defects: Vec<PlacedDefect>,
}

/// Queries of the static geometry that [`Dynamics::build`] needs.
#[derive(Clone, Copy)]
pub struct StaticQueries<'a> {
    /// Function that returns the first hit of a ray.
    pub cast: RayCast<'a>,
    /// Function that returns the nearest surface to a point within a maximum distance, m.
    pub nearest: &'a dyn Fn(Vec3<Enu>, f64) -> Option<NearestPoint>,
}

impl Dynamics {
    /// Draws traffic and defects from a seed and creates the light model.
    #[must_use]
    pub fn build(scenario: &Scenario, seed: u64, members: &[Member], lanes: &[Lane], still: StaticQueries) -> Self {
        let light = LightModel::new(&scenario.light, scenario.origin);
        let ambient = |p, n| light.ambient_lux(p, Some(n), SimTime::ZERO, still.cast);
        let clearance = |p| (still.nearest)(p, defects::CAMERA_CLEARANCE_M).map_or(f64::INFINITY, |n| n.distance_m);
        let ground = PlacementContext {
            members,
            tasks: &scenario.tasks,
            cast: still.cast,
            ambient: &ambient,
            clearance_m: &clearance,
            water_up_m: scenario.terrain.water_level_m,
        };
        let placed = defects::place_defects(&scenario.defects, &ground, seed);
        let traffic = TrafficPlan::new(lanes, &scenario.traffic, &scenario.ground_team, seed);
        let drones = SiteDrones::new(&scenario.drones, seed);
        let ropes = SiteRopes::new(&scenario.ropes, &scenario.wind, seed);
        Self { traffic: traffic.with_drones(drones).with_ropes(ropes), light, defects: placed }
    }

    /// Returns the nearest point within `max_m` of static geometry (`still`), traffic and crew.
    #[must_use]
    pub fn nearest(&self, still: Option<NearestPoint>, position_m: Vec3<Enu>, max_m: f64, at: QueryTime) -> Option<NearestPoint> {
        let reach = still.map_or(max_m, |s| s.distance_m);
        self.traffic.nearest(position_m, reach, at).or(still)
    }

    /// Returns the first hit of a ray within `max_m` among static geometry (`still`), traffic and crew.
    #[must_use]
    pub fn ray(
        &self,
        still: Option<RayHit>,
        origin_m: Vec3<Enu>,
        direction: Vec3<Enu>,
        max_m: f64,
        at: QueryTime,
    ) -> Option<RayHit> {
        let reach = still.map_or(max_m, |s| s.distance_m);
        self.traffic.ray(origin_m, direction, reach, at).or(still)
    }

    /// Returns the visibility of a defect; `None` if it is not within [`visibility::MAX_RANGE_M`] in front of the camera. Traffic can
    /// block the view, but casts no shadows.
    #[must_use]
    pub fn view_defect(
        &self,
        defect: &PlacedDefect,
        pose: &CameraPose,
        optics: (&Camera, &Lamp),
        at: QueryTime,
        still: RayCast,
    ) -> Option<DefectView> {
        let cast = |o, d, max| self.ray(still(o, d, max), o, d, max, at);
        let ambient = |p, n| self.light.ambient_lux(p, Some(n), at, still);
        visibility::evaluate_defect(defect, pose, optics, &cast, &ambient)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Site, Surface};
    use super::*;
    use crate::geodesy::Geo;
    use crate::scenario::bridges::{arch::Arch, suspension::Suspension};
    use crate::scenario::*;
    use crate::speed_unit::SpeedUnit;
    use crate::stick_response::StickResponse;

    /// Number of seeds used to check the placement.
    const SEED_COUNT: u64 = 50;
    const UP: Vec3<Enu> = Vec3::new(0.0, 0.0, 1.0);

    fn bridges() -> Vec<Bridge> {
        let at = |name: &str, north: f64, kind| Bridge {
            name: name.into(),
            center_m: Vec3::new(0.0, north, 45.0),
            heading_deg: 80.0,
            kind,
        };
        vec![
            at("arch", 0.0, BridgeKind::Arch(Arch::default())),
            at("suspension", 400.0, BridgeKind::Suspension(Suspension::default())),
        ]
    }

    fn tasks(bridges: &[Bridge]) -> Vec<Task> {
        let kinds = [
            (0, TaskKind::SlabSide, 5.0, 3.0),
            (0, TaskKind::ArchBottom, 5.0, 3.0),
            (0, TaskKind::Interlayer, 0.0, 1.75),
            (1, TaskKind::PierCircle, 4.5, 2.0),
        ];
        let task = |(k, (bridge, kind, stand_off_m, threshold_m)): (usize, (usize, TaskKind, f64, f64))| {
            let path = bridges[bridge].task_path(kind, stand_off_m).expect("path available for this bridge");
            Task {
                id: k as u32 + 1,
                name: format!("{kind:?}"),
                bridge: Some(bridge),
                kind,
                threshold_m,
                closed: path.closed,
                path_m: path.path_m,
                viewing_directions: path.viewing_directions,
                inspects_surface: true,
                stand_off: None,
                too_close_m: None,
                dark: false,
            }
        };
        kinds.into_iter().enumerate().map(task).collect()
    }

    fn rules() -> (SessionRules, FeedbackThresholds, ScoringParams) {
        let rules = SessionRules {
            battery_temperature_c: 25.0,
            after_crash: AfterCrash::Continue,
            battery: BatteryModel::Paper,
            low_battery_return: false,
            low_battery_pct: 30.0,
            critical_battery_pct: 10.0,
            gnss_shadow: false,
            respawn_after: SimTime::from_s(3.0),
            stick_response: StickResponse::Position,
        };
        let feedback = FeedbackThresholds {
            too_close_m: 2.5,
            too_close_clear_m: 2.8,
            off_path_max_m: 8.0,
            off_path_delay: SimTime::from_s(1.0),
            off_path_hold_time: SimTime::from_s(2.0),
            leave_delay: SimTime::from_ms(2_000),
            visit_delay: SimTime::from_ms(3_000),
            speeding_margin: 0.05,
            speeding_hold_time: SimTime::from_ms(1_000),
            battery_green_pct: 70.0,
            battery_yellow_pct: 30.0,
            text_interval: SimTime::from_s(5.0),
            guidance: GuidancePolicy::Always,
        };
        let scoring = ScoringParams {
            frame_rate_hz: 30.0,
            speed_limit_m_s: 4.4704,
            speed_limit_unit: SpeedUnit::MilesPerHour,
            max_speed_m_s: 13.4112,
            time_best_s: 900.0,
            time_max_s: 1500.0,
            beta: 1.0,
            exact_path: false,
            task_completion_fraction: 0.8,
            clearance_m: 1.5,
        };
        (rules, feedback, scoring)
    }

    /// Creates a scenario with two bridges over water at noon in June.
    fn scenario(cloud_cover: f64) -> Scenario {
        let bridges = bridges();
        let tasks = tasks(&bridges);
        let (rules, feedback, scoring) = rules();
        Scenario {
            name: "test".into(),
            title: "test".into(),
            briefing: Vec::new(),
            briefing_pictures: Vec::new(),
            lesson: Vec::new(),
            seed: None,
            origin: Geo { latitude_deg: 46.5, longitude_deg: 0.0, altitude_m: 400.0 },
            terrain: TerrainSpec {
                size_m: 1600.0,
                spacing_m: 10.0,
                water_level_m: 0.0,
                source: TerrainSource::Flat { height_m: -10.0 },
                photo: None,
            },
            ground_team: GroundTeam {
                pad_m: Vec3::new(-150.0, 100.0, 2.0),
                pad_heading_deg: 0.0,
                pad_half_m: 2.0,
                inspector_m: Vec3::new(-156.0, 100.0, 2.0),
                places_m: Vec::new(),
                truck_m: Vec3::new(-165.0, 100.0, 2.0),
                truck_heading_deg: 0.0,
                home_radius_m: 5.0,
            },
            bridges,
            tasks,
            defects: DefectSpec { count: 10, size_factor: 1.0, ..DefectSpec::default() },
            drones: Vec::new(),
            ropes: Vec::new(),
            traffic: TrafficSpec { cars: 12, trucks: 4, pedestrians: 8, car_speed_m_s: 13.4 },
            wind: WindSpec {
                model: WindModel::Physical,
                speed_m_s: 4.9,
                paper_force_n: 3.0,
                from_deg: 240.0,
                up_m_s: 0.0,
                turbulence: 1.0,
                events: vec![],
            },
            light: LightSpec { start_unix_s: 1_718_884_800, cloud_cover, water_albedo: 0.08, ground_albedo: 0.2 },
            weather: WeatherSpec::default(),
            rules,
            hazards: HazardSpec::default(),
            feedback,
            scoring,
            certification: CertificationParams::default(),
            form: None,
            difficulty: None,
            crc: 0,
        }
    }

    #[test]
    fn prop_defects_on_both_bridges_are_valid_and_photographable() {
        /// Maximum distance of a defect from its member, m.
        const SURFACE_TOLERANCE_M: f64 = 1e-3;
        let mut scenario = scenario(0.5);
        let mut all: Vec<[f64; 3]> = Vec::new();
        for seed in 0..SEED_COUNT {
            let site = Site::build(&scenario, seed);
            let still = site.cast();
            let ambient = |p, n| site.ambient_lux(p, Some(n), SimTime::ZERO);
            let clearance = |p| site.geometry().nearest(p, defects::CAMERA_CLEARANCE_M).map_or(f64::INFINITY, |n| n.distance_m);
            let ground = PlacementContext {
                members: site.members(),
                tasks: &scenario.tasks,
                cast: &still,
                ambient: &ambient,
                clearance_m: &clearance,
                water_up_m: scenario.terrain.water_level_m,
            };
            assert_eq!(site.defects().len(), 10, "seed {seed}");
            let mut per_task = [0; 4];
            for d in site.defects() {
                assert!(d.element.permitted_defects().contains(&d.kind), "{d:?}");
                let k = site.members().iter().position(|m| m.name == d.member).expect("a member of the site");
                assert_eq!(site.members()[k].element, d.element);
                let near = site.geometry().shape(k).expect("has a shape").nearest(d.position_m);
                assert!(near.distance_m.abs() < SURFACE_TOLERANCE_M, "{d:?}");
                let views = (0..4).filter(|t| defects::find_view(d, &scenario.tasks[*t], &ground).is_some());
                let first = views.fold(None, |first, t| {
                    per_task[t] += 1;
                    first.or(Some(t))
                });
                let task = &scenario.tasks[first.expect("photographable from a task's path")];
                let pose = defects::find_view(d, task, &ground).expect("found above");
                let shown = site.view_defects(&pose, &defects::REFERENCE_CAMERA, &defects::REFERENCE_LAMP, SimTime::ZERO);
                let view = shown.iter().find(|v| v.defect_id == d.id).expect("listed");
                let traffic = site.ray(pose.position_m, pose.forward, view.distance_m - 0.05, SimTime::ZERO);
                assert!(view.hit || traffic.is_some_and(|h| h.surface != Surface::Bridge), "{d:?} {:?}", view.reasons());
            }
            assert!(per_task.iter().all(|n| *n >= 2), "seed {seed}: {per_task:?}");
            assert!(site.defects().iter().all(|d| !all.contains(&d.position_m.array())), "position repeated from another seed");
            all.extend(site.defects().iter().map(|d| d.position_m.array()));
        }
        let once = Site::build(&scenario, 7);
        assert_eq!(once.defects(), Site::build(&scenario, 7).defects());
        scenario.defects.placed = Some(once.defects()[..3].to_vec());
        assert_eq!(Site::build(&scenario, 8).defects(), &once.defects()[..3]);
    }

    /// Returns the illuminance, in lx, of the slab's soffit between the stringers at five positions along the arch.
    fn soffit_lux(scenario: &Scenario) -> Vec<f64> {
        let site = Site::build(scenario, 1);
        let placement = scenario.bridges[0].placement();
        let below = |x: f64| placement.point([x, 0.0, -2.0]);
        let lux = |x: f64| {
            let hit = site.ray(below(x), UP, 10.0, SimTime::ZERO).expect("the slab is above");
            site.ambient_lux(below(x) + UP * (hit.distance_m - 0.01), Some(-UP), SimTime::ZERO)
        };
        [1.5, 6.5, 11.5, 21.5, 31.5].map(lux).to_vec()
    }

    #[test]
    fn val_light_on_the_bridges_is_in_the_published_ranges() {
        // docs/src/reference/domain.md, "Light levels": sun 50 to 100 klx (with the sky up to 125), overcast 5 to 20, under a 12
        // m deck with water reflection 200 to 2000 lx (for bright overcast; reflected sun on the lake yields more).
        for (cloud, range) in [(0.0, 50e3..125e3), (1.0, 5e3..20.5e3)] {
            let site = Site::build(&scenario(cloud), 1);
            let over = site.ambient_lux(Vec3::new(0.0, 0.0, 55.0), Some(UP), SimTime::ZERO);
            assert!(range.contains(&over), "{over}");
        }
        let overcast = soffit_lux(&scenario(1.0));
        assert!(overcast.iter().all(|lux| (200.0..2000.0).contains(lux)), "{overcast:?}");
        // At 19:10 UTC the sun is behind clouds about 5 deg above the horizon, and the soffit illuminance drops to 20
        // to 200 lx, the range for dark areas.
        let mut evening = scenario(1.0);
        evening.light.start_unix_s += 7 * 3600 + 600;
        let dark = soffit_lux(&evening);
        assert!(dark.iter().all(|lux| (20.0..200.0).contains(lux)), "{dark:?}");
    }

    #[test]
    fn prop_sky_view_decreases_toward_the_interlayer() {
        let scenario = scenario(0.0);
        let site = Site::build(&scenario, 1);
        let sky = |k: usize| site.sky_view(scenario.tasks[k].path_m[scenario.tasks[k].path_m.len() / 2]);
        assert!(sky(0) > 0.8 && sky(1) < sky(0) && sky(2) < 0.3 && sky(2) < sky(1), "{} {} {}", sky(0), sky(1), sky(2));
    }

    #[test]
    fn prop_traffic_is_on_the_decks_and_clear_of_members() {
        // Vehicles may intersect only the deck: a point 0.3 m above the bottom of every box is free.
        let scenario = scenario(0.0);
        let site = Site::build(&scenario, 4);
        for s in 0..120 {
            let at = SimTime::from_s(f64::from(s) * 3.1);
            for (object, _, solid) in site.dynamics.traffic.solids(at) {
                let [_, _, half_up] = solid.half_m;
                let free = site.geometry().nearest_member(solid.center_m + UP * (0.3 - half_up), 1.0);
                assert!(free.is_none_or(|n| n.distance_m > 0.0), "{} in {free:?}", site.object_name(object));
            }
        }
    }
}
