## Plots

plot-not-applicable = n/a

## Site drawings

plot-flight-plan = Flight from above, north up
plot-flight-oblique = Oblique view of the flight, looking north
plot-flight-side = Side view of the flight at bridge '{ $bridge }'
plot-flight-south = Flight viewed from the south
plot-defect = defect { $defect }: { $outcome }
plot-reference = reference path of task { $task }
plot-crash = crash with { $object } at { $moment }
plot-session-crash = session { $session }: crash with { $object } at { $moment }
plot-session = session { $session }
plot-picture = picture { $picture }: { $verdict }
plot-pad = pad
plot-inspector = inspector
plot-place = place { $place } of the inspector
plot-walk = the inspector walks to place { $place } at { $moment }
plot-truck = truck
plot-north = N
plot-both-plan = Both flights from above, north up
plot-both-side = Side view of both flights at bridge '{ $bridge }'
plot-both-south = Both flights viewed from the south
plot-job-plan = Job site from above, north up
plot-job-side = Side view of bridge '{ $bridge }'
plot-job-south = Job site viewed from the south
plot-site-picture = Picture of the site
plot-color-path = on path
plot-color-speed = speed
plot-color-clearance = clearance
plot-legend-between = between tasks
plot-legend-on-path = on the path
plot-legend-off-path = off path during a task
plot-legend-speed = up to { $speed } m/s
plot-legend-speeding = over the limit of { $speed } m/s
plot-legend-far = nothing nearby
plot-legend-over = over { $limit } m
plot-legend-range = { $low } to { $high } m
plot-legend-under = under { $limit } m
plot-air = { $caption }. Mean speed of the air in the plane: { $slowest } to { $fastest } m/s
plot-air-place = { $number }: { $speed } m/s different from the undisturbed wind at { $moment }
plot-legend-air-speed = { $low } to { $high } m/s
plot-legend-air-arrow = direction and speed in the plane
plot-legend-air-turbulence = turbulence of at least { $share }% of the undisturbed wind
plot-legend-air-flown = flown near the plane
plot-legend-air-flown-far = flown above or below it
plot-legend-air-deck = edges of the deck

## Statistics

plot-box =
    { $name }: median { $median }, quartiles { $low } to { $high }, { $trainees ->
        [one] { $trainees } trainee
       *[other] { $trainees } trainees
    }
plot-bin = { $count } from { $low } to { $high }
plot-mean = mean { $mean }
plot-predicted = predicted next: { $value }
plot-model-demand = Demand
plot-model-demand-parts = mental, physical
plot-model-strain = Strain
plot-model-strain-parts = pressure, frustration
plot-model-performance = Performance
plot-model-performance-parts = overall score (%)
plot-model-feedback = Feedback
plot-model-feedback-parts = helpfulness
