# The briefing before a flight. The pages that show it have their own headings.

# Names of the conditions.
briefing-aircraft = aircraft
briefing-tasks = tasks
briefing-time = time
briefing-speed = speed
briefing-defects = defects
briefing-wind = wind
briefing-light = light
briefing-sky = sky
briefing-traffic = traffic

# Conditions.
briefing-tasks-and-length = { $tasks }, { $length } m of path
briefing-time-needed = about { $needed } min needed, { $allowed } min allowed
briefing-speed-limit = { $speed } m/s for inspection, limit { $limit }
briefing-no-defects = none
briefing-defects-to-find = { $count } to find
briefing-wind-from = { $wind } from { $bearing }°
briefing-calm = calm
briefing-sun = { $time } solar time, sun { $height }° high
briefing-no-sun = { $time } solar time, no sun
briefing-clouds = { $share }% clouds
briefing-visibility = visual range { $distance } m
briefing-rain = rain { $rate } mm/h
briefing-snow = snow { $rate } mm/h
briefing-cars = { $count ->
        [one] { $count } car
       *[other] { $count } cars
    }
briefing-trucks = { $count ->
        [one] { $count } truck
       *[other] { $count } trucks
    }
briefing-pedestrians = { $count ->
        [one] { $count } pedestrian
       *[other] { $count } pedestrians
    }
briefing-drones = { $count ->
        [one] { $count } other drone
       *[other] { $count } other drones
    }

# Tasks: where, in which direction, and their numbers.
briefing-hover = hover at one place
briefing-place = { $kind ->
        [slab_side] along the edge of the deck
        [arch_bottom] under the arch
        [interlayer] between the arch and the deck
        [pier_circle] around the pier
        [girder_soffit] under the girders
        [bearing_line] along the bearings
        [pier_cap] around the pier cap
        [truss_panel] along the outside of the truss
        [floor_system] under the floor
        [barrel_soffit] under the barrel
        [arch_ring] along the arch ring
        [stay_cable] along the stay
       *[free] along the free path
    }{ $named ->
        [yes] {" "}of bridge '{ $bridge }'
       *[no] {""}
    }
briefing-place-and-way = { $place }, { $way }
briefing-way-loop = once around, in either direction
briefing-way-back = ending where it starts
briefing-way-up = from bottom to top
briefing-way-down = from top to bottom
briefing-way = from { $from } to { $to }
briefing-north = north
briefing-northeast = northeast
briefing-east = east
briefing-southeast = southeast
briefing-south = south
briefing-southwest = southwest
briefing-west = west
briefing-northwest = northwest
briefing-length = { $length } m long
briefing-height-above = { $height } m above the pad
briefing-height-below = { $height } m below the pad
briefing-heights = { $low } to { $high } m above the pad
briefing-stand-off = stand-off { $distance } ± { $tolerance } m
briefing-within = within { $distance } m of the path
briefing-lamp-needed = lamp needed

# Hazards.
briefing-confined = Confined space: in task { $task }, structure comes within { $clearance } m of the path.
briefing-darkness = Darkness: the lamp is needed in { $count ->
        [one] task { $tasks }
       *[other] tasks { $tasks }
    }.
briefing-vehicles = Traffic: { $count ->
        [one] { $count } vehicle
       *[other] { $count } vehicles
    } on the bridges. Stay away from the roadway.
briefing-people = People: { $count ->
        [one] { $count } pedestrian
       *[other] { $count } pedestrians
    } on the walkways. Never fly above them.
briefing-other-drones = Other drones: { $count ->
        [one] { $count } drone flies a fixed path here and will not avoid you. Keep it in sight and stay clear.
       *[other] { $count } drones fly fixed paths here and will not avoid you. Keep them in sight and stay clear.
    }
briefing-ropes = Ropes: { $count ->
        [one] { $count } rope or cable hangs
       *[other] { $count } ropes or cables hang
    } at the site and { $count ->
        [one] swings
       *[other] swing
    } in the wind. Range finders hardly see them, so watch the pictures.
briefing-satellites = GNSS: the structure blocks satellites. Under the deck, the position can drift.
briefing-compass = Compass: steel distorts the magnetic field. Near steel members, the indicated heading can be wrong, and the position can drift.
briefing-wakes = Wakes: behind piers and towers, the wind is weaker and turbulent, and it swings from side to side. At the edges of a deck, it changes suddenly, and below the deck it is faster.
briefing-cold-battery = Cold battery ({ $temperature } °C): its voltage sags in climbs, so that the drone has less thrust.
briefing-flow-over-water = Water: optical flow and the range finder below are unreliable over water, so that a hold can drift.
briefing-real-sky = GNSS: bridges hide satellites, and water and walls reflect their signals. Near and under the bridges, the position and especially the height can be wrong, and jump when satellites return.
briefing-radio = Radio: concrete and steel weaken the signals between you and the drone. Behind or below a bridge, the picture breaks up first, then control is lost.
briefing-water = Water: parts of the paths are above water. An emergency landing there loses the aircraft.
briefing-crash-ends = A crash ends the session.
briefing-wind-force = Wind: a force of { $force } N.{ $changes ->
        [yes] {" "}It changes or gusts during the flight.
       *[no] {""}
    } Expect to be pushed off the path.
briefing-wind-speed = Wind: { $speed } m/s on average.{ $changes ->
        [yes] {" "}It changes or gusts during the flight.
       *[no] {""}
    } Expect turbulence behind piers and under the deck.

# What counts.
briefing-conformity = Conformity: stay on the path, and below the speed limit while you are on it.
briefing-efficiency = Efficiency: land before the time is over and before the battery is empty.
briefing-safety = Safety: touch nothing. A person or a vehicle that is hit ends the session.
briefing-accuracy = Accuracy: photograph every defect once, near the middle of the picture, and nothing else.
briefing-to-be-certified = To be certified: { $requirement }.

# The site check.
briefing-check-risk = Risk: I know the hazards, and I stop if somebody enters the flight area.
briefing-check-battery = Battery: full. I land with at least { $least }%, and fly home at the low-battery warning ({ $low }%).
briefing-check-landing = Landing place: the pad, { $away } m from the inspector. Landings within { $radius } m of it count as home.
briefing-check-places = Line of sight: I keep the drone in sight. If necessary, I walk to { $count ->
        [one] the other place
       *[other] one of the { $count } other places
    } on the plan.

# At a terminal, below the briefing.
briefing-confirm = Press Enter to confirm the site check and begin the flight.
