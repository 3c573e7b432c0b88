# Requirements of the certification, and reasons why they are not met or why pictures do not count.

# Names of the requirements.
certification-tasks-done = tasks done
certification-landed-at-home = landed at home
certification-person-or-vehicle-hits = people and vehicles hit
certification-battery = battery at landing
certification-contacts = contacts
certification-contact-speed = fastest contact
certification-conformity = conformity
certification-precision = precision
certification-safety = safety
certification-accuracy = accuracy
certification-practice-aids = freezes and rewinds

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
certification-unmet-contacts = { $contacts } contacts, at most { $limit } allowed
certification-unmet-contact-speed = contact at { $speed }, at most { $limit } allowed
certification-unmet-score = { $score } { $value }, { $needed } needed
certification-unmet-no-evidence = no evidence for { $score }

# Reasons why a picture does not count. The English ones are stored, too.
certification-picture-of-defect = defect { $defect }: { $reason }
certification-picture-resolution = resolution { $value } mm/px, limit { $limit } mm/px
certification-picture-motion-blur = motion blur { $value } px, limit { $limit } px
certification-picture-incidence = incidence { $value } deg, limit { $limit } deg
certification-picture-too-fine = too fine for this camera
certification-picture-not-central = not in the central 80% of the image
certification-picture-hidden = hidden behind something
certification-picture-too-oblique = too oblique: { $value } deg, limit { $limit } deg
certification-picture-too-small = too small: { $value } px, at least { $limit } px
certification-picture-line-too-thin = line too thin: { $value } px, at least { $limit } px
certification-picture-dark-lamp-on = too dark: lamp on, { $value } lx of { $limit } lx needed
certification-picture-dark-lamp-off = too dark: lamp off, { $value } lx of { $limit } lx needed

# Requirements of a job, in its briefing.
certification-job-tasks = every task flown over at least { $share }% of its path
certification-job-landing = landed at home with at least { $battery }% battery, no person or vehicle hit
certification-job-aids = no freezes and no rewinds, which are aids of practice
certification-job-contacts = at most { $contacts } contacts, none faster than { $speed } m/s
certification-job-scores = conformity at least { $conformity }, precision { $precision }, safety { $safety }, accuracy { $accuracy }
certification-job-pictures = pictures with at most { $resolution } mm/px ({ $width } of the width for a crack), { $blur } px of motion blur and { $incidence } deg of incidence
