# Requirements of the certification, and reasons why they are not met or why pictures do not count.

# Names of the requirements.
certification-tasks-done = tasks done
certification-landed-at-home = landed at home
certification-person-or-vehicle-hits = people and vehicles hit
certification-battery = battery at landing
certification-contacts = contacts
certification-contact-speed = fastest contact
certification-conformity = coverage-weighted conformity
certification-precision = flight precision
certification-safety = impact-weighted safety
certification-accuracy = detection accuracy
certification-efficiency = time efficiency
certification-practice-aids = freezes and rewinds

# How the value of each requirement is measured.
certification-explain-tasks-done = Every task counts as done once enough of its path has been flown.
certification-explain-landed-at-home = The session must end with a landing near the ground team.
certification-explain-person-or-vehicle-hits = People and vehicles that the drone touched, parked vehicles included.
certification-explain-battery = The charge left after the landing.
certification-explain-contacts = How often the drone touched the bridge, the ground or the water; touches less than a second apart count once.
certification-explain-contact-speed = The highest speed at which the drone touched something.
certification-explain-conformity = The time on the path within the speed limit, weighted by how much of each path was flown. The TASBID score conformity ignores parts of the path that were left out.
certification-explain-precision = How small the errors of distance to the path, speed, camera direction and clearance were during the tasks.
certification-explain-safety = 100 points, less a loss for each contact, which grows with its speed, and for the time too close to a surface; 0 if a person or vehicle was hit.
certification-explain-accuracy = The share of defects found and the share of pictures that show one, combined. Unlike in the TASBID score accuracy, only pictures with enough detail and little blur count.
certification-explain-efficiency = The flight time compared with the time that this job needs with the defects found.
certification-explain-practice-aids = Freezes and rewinds are aids of practice; a certified flight has none.

# Limits and values.
certification-at-least = at least { $limit }
certification-at-most = at most { $limit }
certification-points = { $value } points
certification-yes = yes
certification-no = no
certification-does-not-apply = does not apply
certification-no-evidence = no evidence

# Unmet requirements. The English ones are stored; the words between the variables identify them.
certification-unmet-practice = { $aids }, so it was practice
certification-unmet-hit = a person or vehicle was hit
certification-unmet-task-part = task { $task } not done: { $share }% of its path, { $needed }% needed
certification-unmet-task-not-attempted = task { $task } not attempted
certification-unmet-landing = not landed at home
certification-unmet-battery = { $battery } battery at landing, { $needed }% needed
certification-unmet-one-contact = 1 contact, at most { $limit } allowed
certification-unmet-contacts = { $contacts } contacts, at most { $limit } allowed
certification-unmet-contact-speed = contact at { $speed }, at most { $limit } allowed
certification-unmet-score = { $score } { $value }, { $needed } needed
certification-unmet-no-evidence = no evidence for { $score }

# Reasons why a picture does not count. The English ones are stored, too.
certification-picture-resolution = resolution { $value } mm/px, limit { $limit } mm/px
certification-picture-motion-blur = motion blur { $value } px, limit { $limit } px
certification-picture-incidence = incidence { $value } deg, limit { $limit } deg
certification-picture-too-fine = too fine for this camera

# Requirements of a job, in its briefing.
certification-job-tasks = every task flown over at least { $share }% of its path
certification-job-landing = landed at home with at least { $battery }% battery, no person or vehicle hit
certification-job-aids = no freezes and no rewinds, which are aids of practice
certification-job-contacts =
    { $contacts ->
        [one] at most { $contacts } contact
       *[other] at most { $contacts } contacts
    }, { $contacts ->
        [one] not
       *[other] none
    } faster than { $speed } m/s
certification-job-scores = coverage-weighted conformity at least { $conformity }, flight precision { $precision }, impact-weighted safety { $safety }, detection accuracy { $accuracy }
certification-job-scores-without-defects = coverage-weighted conformity at least { $conformity }, flight precision { $precision }, impact-weighted safety { $safety }
certification-job-pictures = pictures with at most { $resolution } mm/px ({ $width } of the width for a crack), { $blur } px of motion blur and { $incidence } deg of incidence
