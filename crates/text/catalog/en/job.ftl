# Titles and task names of the shipped jobs, and states of assigned jobs.

# Titles. The English ones are those in the scenario files.
job-box-girder = Box girder bridge: outer web, soffit of the last span, pier cap, bearings
job-cable-stayed = Cable-stayed bridge: floor of a side span, edge girder, stay
job-certification = Certification: two bridges, 64 defects
job-drill-barrel = Drill: barrel
job-drill-curve-under-arch = Drill: curve under the arch
job-drill-framing = Drill: framing
job-drill-gap = Drill: gap
job-drill-girder-bays = Drill: girder bays
job-drill-haunches = Drill: haunches
job-drill-hover = Drill: hover
job-drill-lamp = Drill: lamp
job-drill-landing = Drill: landing
job-drill-orbit = Drill: orbit
job-drill-search = Drill: search
job-drill-stand-off = Drill: stand-off
job-drill-stay-cable = Drill: stay cable
job-drill-straight-line = Drill: straight line
job-drill-truss-panels = Drill: truss panels
job-first-flight = Lesson: first flight
job-girder = Girder bridge: outer girder, girder bays, pier cap, bearings
job-masonry-arch = Masonry arch bridge: arch ring, spandrel wall, barrel, pier
job-pilot-study = Pilot study: slab side, arch bottom, interlayer, pier
job-practice = Practice at two bridges
job-prestressed = Prestressed girder bridge: outer girder, girder bays, pier cap, bearings
job-truss = Truss bridge: truss panels, floor system, pins and bearings
job-two-bridges = Two bridges: slab side, arch bottom, interlayer, pier
job-winter = Winter at a girder bridge: cold battery, weak radio, hanging ropes

# Names of tasks.
job-task-curve = Curve under the arch
job-task-slab-framing = Side of the slab, camera on the slab
job-task-gap = Gap between deck and arch
job-task-hover = Hover
job-task-dark-arch = Arch bottom in the dark
job-task-out-and-back = Out and back
job-task-orbit = Orbit
job-task-pier-faces = Pier, all faces
job-task-pier-stand-off = Pier at 3 m
job-task-straight-line = Straight line
job-task-square = Square
job-task-slab = Slab of the arch bridge from one side
job-task-arch = Arch-shaped bottom
job-task-interlayer = Interlayer between deck and arch
job-task-pier = Pier of the suspension bridge near the water
job-task-outer-girder = Outer girder and deck edge
job-task-girder-bays = Girder bays of the last span
job-task-bearings = Bearings on the start abutment
job-task-pier-cap = Cap of the first pier
job-task-middle-bays = Girder bays of the middle span
job-task-outer-web = Outer web and deck edge
job-task-main-soffit = Soffit of the main span
job-task-last-soffit = Soffit of the last span
job-task-spandrel-wall = Right spandrel wall and parapet
job-task-barrel = Barrel of the middle span
job-task-last-barrel = Barrel of the last span
job-task-arch-ring = Arch ring of the first span
job-task-cutwaters = First pier and its cutwaters
job-task-edge-girder = Edge girder, stays and deck edge
job-task-longest-stay = Longest stay of the start tower
job-task-side-floor = Floor of the start side span
job-task-pier-bearings = Bearings on the second pier
job-task-right-truss = Right truss of the first span
job-task-floor = Floor system of the second span
job-task-pins = Pins and bearings on the pier

# States of an assigned job.
job-state-open = open
job-state-overdue = overdue
job-state-done = done
job-state-done-late = done late

# How a trainee flies a job.
job-how-to-fly = In the simulator window, choose this job on the start page.
job-how-to-fly-assigned = On the start page of the simulator window: { $row }
