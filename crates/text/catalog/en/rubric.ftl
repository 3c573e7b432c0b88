# The default rubric. The English texts are those in the data file.
rubric-preparation = Prepares the flight
rubric-preparation-text = Reads the briefing, names the hazards (wind, traffic, light), confirms the site check, and knows where to land if something goes wrong.
rubric-control = Controls the aircraft
rubric-control-text = Takes off, hovers, turns and lands at home smoothly and without help, also with the nose toward the pilot.
rubric-path = Flies the path
rubric-path-text = Flies the whole path of each task within its tolerance and under the speed limit, and finds the way back after leaving it.
rubric-clearance = Keeps clear
rubric-clearance-text = Keeps the recommended stand-off and never comes closer to structure, people or vehicles than allowed. Reacts to warnings at once.
rubric-pictures = Takes pictures that count
rubric-pictures-text = Frames the defect sharply, close enough and square enough to measure it, and uses the lamp where it is dark.
rubric-defects = Finds defects
rubric-defects-text = Searches every element systematically, tells defects from surface marks, and names the element and the condition state.
rubric-battery = Manages time and battery
rubric-battery-text = Plans the order of the tasks, watches the battery, and is home with a reserve and within the allowed time.
rubric-failures = Handles failures
rubric-failures-text = Stays calm and keeps control when satellite navigation or the compass fails or when orientation is lost, and decides to break off in time.

# Decisions of an instructor.
rubric-signed-off = signed off
rubric-withdrawn = withdrawn
