# The defect school: questions, answers and verdicts.
school-nothing = No defect can be seen from here
school-question = { $element }, element { $number }. The middle of a photograph at full resolution, taken from { $distance } m with the lamp on.
school-right = Right.
school-wrong = Wrong: not { $defect }.
school-wrong-nothing = Wrong: there is a defect.
school-sound-surface = The surface is sound. Stains, form lines, sealed cracks, spider webs and spray paint aren't defects.
school-hidden = There is a defect here ({ $defect }), but it can't be seen from { $distance } m: a pixel covers { $pixel } mm. { $size } Fly closer.
school-card = { $subject } from { $distance } m
school-sound = sound surface
school-size-line = It is { $width } mm wide and { $length } mm long.
school-size-area = It measures { $length } mm by { $width } mm.

# How to recognize defects.
school-corrosion = Corrosion: rough, red-brown patches on steel.
school-fatigue = Fatigue cracking: a very thin line in steel, often with rust along it.
school-connection = Connection: a bolt or rivet is missing or loose.
school-spall = Spall: a hollow with a sharp edge. The concrete in it is lighter and rougher.
school-rebar = Exposed rebar: orange-brown bars in a hollow in the concrete.
school-efflorescence = Efflorescence or rust staining: white or brown streaks that run down the surface.
school-abrasion = Abrasion: a worn patch in which the aggregate shows.
school-mortar = Mortar breakdown: joints between stones that are open, deep and dark.
school-split-stone = Split stone: a stone whose face has come off, with a fresh, lighter surface.
school-crack = Cracking: a thin, dark, irregular line, or a net of such lines.
school-defect = A defect.
