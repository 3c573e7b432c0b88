# Things to do better after a flight.
advice-lesson = The scores of a lesson don't matter. Once you have done every step, fly the first drill.
advice-nothing-to-correct = Nothing to correct: fly the next job.
advice-certified = You are certified, and no single mistake stands out.
advice-not-certified = No single mistake stands out, but you are not certified yet: { $unmet }.
advice-fly-again = No single mistake stands out: fly the job again.
advice-not-finished = No single mistake stands out, but the job is not finished: fly it to the end.

# Phrases that stand in other sentences: the last items of a list, and where, how long and when.
advice-and = { $first } and { $last }
advice-when = { $place ->
        [task] in task { $tasks } for
        [tasks] in tasks { $tasks } for
       *[none] for
    } { $time }{ $stretches ->
        [one] {" "}from { $from }
       *[other] , longest from { $from }
    }

# How the drone was flown.
advice-off-path = You left the path { $when }, up to { $most } m away: return before you go on.
advice-drifted-up = You drifted { $mean } m above the path { $when }: hold your altitude.
advice-drifted-down = You drifted { $mean } m below the path { $when }: hold your altitude.
advice-beside-path = You flew { $mean } m beside the path { $when }: fly on the path itself.
advice-too-far = You flew { $mean } m too far from { $surface ->
        [slab_side] the deck
        [arch_bottom] the arch
        [pier_circle] the pier
        [girder_soffit] the girders
        [pier_cap] the pier cap
        [truss_panel] the truss
        [floor_system] the floor
        [barrel_soffit] the barrel
        [arch_ring] the arch ring
        [stay_cable] the stays
       *[structure] the structure
    } { $when }: move closer.
advice-too-close = You flew { $mean } m too close to { $surface ->
        [slab_side] the deck
        [arch_bottom] the arch
        [pier_circle] the pier
        [girder_soffit] the girders
        [pier_cap] the pier cap
        [truss_panel] the truss
        [floor_system] the floor
        [barrel_soffit] the barrel
        [arch_ring] the arch ring
        [stay_cable] the stays
       *[structure] the structure
    } { $when }: back off.
advice-uneven-distance = Your distance from { $surface ->
        [slab_side] the deck
        [arch_bottom] the arch
        [pier_circle] the pier
        [girder_soffit] the girders
        [pier_cap] the pier cap
        [truss_panel] the truss
        [floor_system] the floor
        [barrel_soffit] the barrel
        [arch_ring] the arch ring
        [stay_cable] the stays
       *[structure] the structure
    } varied, up to { $most } m off at { $at }: follow the shape of the path.
advice-uneven-height = Your height above the path changed{ $place ->
        [task] {" "}in task { $tasks }
        [tasks] {" "}in tasks { $tasks }
       *[none] {""}
    }, up to { $most } m off at { $at }: hold your height.
advice-too-high = You flew { $mean } m above the path { $when }: descend to it.
advice-too-low = You flew { $mean } m below the path { $when }: climb to it.
advice-speeding = You flew up to { $most } m/s{ $place ->
        [task] {" "}in task { $tasks }
        [tasks] {" "}in tasks { $tasks }
       *[none] {""}
    }, over the { $limit } m/s limit { $when }: slow down.
advice-low-clearance = You were less than { $limit } m from the structure { $when }, { $least } m at the closest: keep your distance.
advice-stick-reversals = You reversed the sticks up to { $most } times a minute{ $place ->
        [task] {" "}in task { $tasks }
        [tasks] {" "}in tasks { $tasks }
       *[none] {""}
    }, most often from { $at }: make small, smooth corrections.
advice-stick-jumps = You jerked the sticks up to { $most } times a minute{ $place ->
        [task] {" "}in task { $tasks }
        [tasks] {" "}in tasks { $tasks }
       *[none] {""}
    }, most often from { $at }: move them gradually.
advice-yaw-reversals = You reversed the yaw stick up to { $most } times a minute{ $place ->
        [task] {" "}in task { $tasks }
        [tasks] {" "}in tasks { $tasks }
       *[none] {""}
    }, most often from { $at }: hold your heading.

# Camera and lamp.
advice-framing = Your camera pointed up to { $most } degrees away from { $surface ->
        [slab_side] the deck
        [arch_bottom] the arch
        [pier_circle] the pier
        [girder_soffit] the girders
        [pier_cap] the pier cap
        [truss_panel] the truss
        [floor_system] the floor
        [barrel_soffit] the barrel
        [arch_ring] the arch ring
        [stay_cable] the stays
       *[structure] the structure
    } { $when }: turn the nose toward it.
advice-lamp-off = Your lamp was off in the dark { $when }: switch it on in the shade.

# Crashes.
advice-crash-times = at { $times }
advice-crash-first-and-hardest = first at { $first }, hardest at { $hardest } ({ $speed } m/s)
advice-crash = You hit { $object ->
        [bridge] the bridge
        [terrain] the ground
        [water] the water
        [vehicle] a vehicle
        [person] a person
        [other] an obstacle
        [none] nothing
       *[several] obstacles
    } { $count ->
        [1] once
        [2] twice
       *[other] { $count } times
    }{ $place ->
        [task] {" "}in task { $tasks }
        [tasks] {" "}in tasks { $tasks }
        [between] {" "}between the tasks
       *[none] {""}
    }, { $when }: { $remedy ->
        [altitude] hold your altitude
        [people] stay clear of people and traffic
       *[distance] keep your distance
    }.

# Defects and pictures.
advice-missed-in-view = You missed { $missed } of { $all } { $kind ->
        [severe] severe defects
        [hidden] defects that face away from the path
        [cracks] cracks
       *[all] defects
    }; defect { $defect } was in clear view at { $at }: stop and take a picture.
advice-missed-nearest = You missed { $missed } of { $all } { $kind ->
        [severe] severe defects
        [hidden] defects that face away from the path
        [cracks] cracks
       *[all] defects
    }; at { $at } you were nearest to a view of defect { $defect }: search slowly there.
advice-passed-in-view = You passed { $count ->
        [one] a defect
       *[other] { $count } defects
    } in clear view without a picture, the longest for { $seconds } s at { $at }: fly slower or closer there.
advice-picture-failed = Your { $count ->
        [one] picture of a defect was
       *[other] pictures of { $count } defects were
    } { $why ->
        [dark] too dark
        [oblique] taken at too flat an angle
        [small] taken from too far away
        [thin] taken from too far for a fine crack
       *[other] { $reason }
    }, first at { $at }: { $why ->
        [dark] switch on the lamp
        [oblique] point the nose straight at the surface
        [small] move closer
        [thin] move closer
       *[other] correct this before the picture
    }.
advice-picture-poor =
    { $found ->
        [one] Your pictures of the defect that you found
       *[other] Your pictures of { $count } of the { $found } defects that you found
    } are { $why ->
        [blur] blurred by motion
        [coarse] too coarse
        [oblique] taken at too flat an angle
       *[other] not good enough
    }, first at { $at }: { $why ->
        [blur] stop before the picture
        [coarse] move closer
        [oblique] point the nose straight at the surface
       *[other] check what the report says about each one
    }.
advice-no-pictures =
    { $count ->
        [one] You took no picture of the defect
       *[other] You took no picture of the { $count } defects
    }; your best chance was at { $at }: photograph every defect.
advice-none-found =
    { $all ->
        [one] You did not photograph the defect
       *[other] You photographed none of the { $all } defects
    }{ $place ->
        [task] {" "}of task { $tasks }
        [tasks] {" "}of tasks { $tasks }
       *[none] {""}
    }; at { $at } you were nearest to a view of defect { $defect }: search every task to its end.
advice-moving-pictures =
    { $taken ->
        [one] You took your only picture in motion, at
       *[other] You took { $count } of { $taken } pictures in motion, { $count ->
            [one] at
           *[other] first at
        }
    } { $at }: stop before every picture.
advice-drifting-pictures =
    { $taken ->
        [one] The drone was drifting when you took your only picture, at
       *[other] The drone was drifting in { $count } of { $taken } pictures, { $count ->
            [one] at
           *[other] first at
        }
    } { $at }: let it come to rest first.
advice-turning-pictures =
    { $taken ->
        [one] You were turning when you took your only picture, at
       *[other] You were turning in { $count } of { $taken } pictures, { $count ->
            [one] at
           *[other] first at
        }
    } { $at }: hold the heading until the picture is taken.
advice-unlit-pictures =
    { $count ->
        [one] The lamp was off in one picture{ $place ->
        [task] {" "}in task { $tasks }
        [tasks] {" "}in tasks { $tasks }
       *[none] {""}
    }, at
       *[other] The lamp was off in { $count } pictures{ $place ->
        [task] {" "}in task { $tasks }
        [tasks] {" "}in tasks { $tasks }
       *[none] {""}
    }, first at
    } { $at }: switch it on before the picture.
advice-pictures-of-nothing = { $taken ->
        [one] Your only picture, at { $at }, shows no new defect
       *[other] { $count } of your { $taken } pictures { $count ->
            [one] shows no new defect, at { $at }
           *[other] show no new defect, first at { $at }
        }
    }: look first, then take the picture.

# What was left undone, and the end of the flight.
advice-not-attempted = You did not fly { $place ->
        [task] task { $tasks }
        [tasks] tasks { $tasks }
       *[none] the task
    }: the flight ended at { $at }.
advice-not-covered = You flew only { $shares } of { $place ->
        [task] the path of task { $tasks } and left it
        [tasks] the paths of tasks { $tasks } and left task { $least }
       *[none] the path and left it
    } at { $at }: fly each path to its end.
advice-overtime = You flew for { $flown }, { $over } longer than full points allow; the time was up at { $at }: plan the order of the tasks.
advice-slow = You flew for { $flown }; at inspection speed, this job takes { $needed }. From { $at } on, you were over that time: don't linger where there is nothing to see.
advice-landing = Your landing took { $took } from your last approach at { $at }: descend steadily and touch down.
advice-not-landed = Your flight ended at { $at }, { $away } m from the pad: fly back and land on it.
advice-battery-low = You ended with { $left }% battery; the { $reserve }% reserve was reached at { $at }: turn back earlier.
advice-time-up = Your time was up at { $at }, { $away } m from the pad: turn back earlier.
advice-battery-empty = Your battery was empty at { $at }, { $away } m from the pad: turn back earlier.
