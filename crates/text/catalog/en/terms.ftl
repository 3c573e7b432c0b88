# Names of bridge elements, defects, scores and tasks, in the wording of AASHTO MBEI, DIN 1076 and RI-EBW-PRÜF.

# Bridge elements by their AASHTO number.
terms-element-12 = deck, reinforced concrete
terms-element-13 = deck, prestressed concrete
terms-element-15 = top flange, prestressed concrete
terms-element-16 = top flange, reinforced concrete
terms-element-28 = open grid deck, steel
terms-element-29 = concrete-filled grid deck, steel
terms-element-30 = orthotropic deck, steel
terms-element-31 = deck, timber
terms-element-38 = slab, reinforced concrete
terms-element-39 = slab, prestressed concrete
terms-element-102 = box girder, steel
terms-element-104 = box girder, prestressed concrete
terms-element-105 = box girder, reinforced concrete
terms-element-107 = girder, steel
terms-element-109 = girder, prestressed concrete
terms-element-110 = girder, reinforced concrete
terms-element-113 = stringer, steel
terms-element-115 = stringer, prestressed concrete
terms-element-116 = stringer, reinforced concrete
terms-element-120 = truss, steel
terms-element-141 = arch, steel
terms-element-142 = arch, other
terms-element-143 = arch, prestressed concrete
terms-element-144 = arch, reinforced concrete
terms-element-145 = arch, masonry
terms-element-147 = main cable, steel
terms-element-148 = hanger, steel
terms-element-149 = secondary cable, other
terms-element-152 = floor beam, steel
terms-element-154 = floor beam, prestressed concrete
terms-element-155 = floor beam, reinforced concrete
terms-element-161 = pin or pin and hanger, steel
terms-element-162 = gusset plate, steel
terms-element-202 = column, steel
terms-element-204 = column, prestressed concrete
terms-element-205 = column, reinforced concrete
terms-element-207 = tower, steel
terms-element-210 = pier wall, reinforced concrete
terms-element-213 = pier wall, masonry
terms-element-215 = abutment, reinforced concrete
terms-element-217 = abutment, masonry
terms-element-220 = footing, reinforced concrete
terms-element-225 = pile, steel
terms-element-226 = pile, prestressed concrete
terms-element-227 = pile, reinforced concrete
terms-element-231 = pier cap, steel
terms-element-233 = pier cap, prestressed concrete
terms-element-234 = pier cap, reinforced concrete
terms-element-300 = strip seal joint
terms-element-301 = pourable joint seal
terms-element-302 = compression joint seal
terms-element-303 = assembly joint with seal
terms-element-304 = open joint
terms-element-305 = assembly joint without seal
terms-element-306 = joint, other
terms-element-310 = elastomeric bearing
terms-element-311 = movable bearing
terms-element-312 = enclosed bearing
terms-element-313 = fixed bearing
terms-element-314 = pot bearing
terms-element-315 = disk bearing
terms-element-316 = bearing, other
terms-element-320 = approach slab, prestressed concrete
terms-element-321 = approach slab, reinforced concrete
terms-element-330 = railing, metal
terms-element-331 = railing, reinforced concrete
terms-element-332 = railing, timber
terms-element-333 = railing, other
terms-element-334 = railing, masonry
terms-element-510 = wearing surface
terms-element-515 = protective coating of steel
terms-element-520 = protective system of reinforcing steel
terms-element-521 = protective coating of concrete
terms-element-unlisted = element

# Defects.
terms-defect-corrosion = corrosion
terms-defect-fatigue = fatigue cracking
terms-defect-connection = connection
terms-defect-spall = delamination or spall
terms-defect-rebar = exposed rebar
terms-defect-psc-crack = cracking (prestressed)
terms-defect-efflorescence = efflorescence or rust staining
terms-defect-crack = cracking
terms-defect-abrasion = abrasion
terms-defect-mortar = mortar breakdown
terms-defect-split-stone = split or spalled stone
terms-defect-unknown = defect
terms-cause-bending = bending
terms-cause-shear = shear
terms-cause-shrinkage = restrained shrinkage of the deck
terms-cause-swelling = swelling of the concrete (alkali-silica reaction or frost)
terms-cause-leaking-joint = leaking joint above
terms-cause-drain = deck drain
terms-cause-reinforcement = rusting reinforcement
terms-cause-edge = load or water at an edge
terms-cause-water-line = ice, debris and sand at the water line
terms-cause-weld = stress concentration at the end of a weld
terms-cause-fasteners = loose fasteners at a splice
terms-cause-cable = water in the lowest part of the cable
terms-cause-seepage = water that seeps through the fill
terms-cause-frost = frost in wet stones

# Scores.
terms-score-overall = overall
terms-score-conformity = conformity
terms-score-efficiency = efficiency
terms-score-safety = safety
terms-score-accuracy = accuracy

# Objects hit.
terms-contact-none = none
terms-contact-bridge = bridge
terms-contact-ground = ground
terms-contact-water = water
terms-contact-vehicle = vehicle
terms-contact-person = person
terms-contact-other = other

# Why a flight ended. Pages and the window put them at the beginning of a sentence or after a comma.
terms-end-landed = landed
terms-end-battery = battery empty
terms-end-time-limit = time limit reached
terms-end-person = hit a person
terms-end-vehicle = hit a vehicle
terms-end-crash = crashed
terms-end-abort = ended early
terms-end-restart = simulator restarted

# Purpose of a flight.
terms-purpose-practice = practice
terms-purpose-assessment = assessment

# Directions as seen from the aircraft.
terms-direction-forward = forward
terms-direction-back = back
terms-direction-right = right
terms-direction-left = left
terms-direction-up = up
terms-direction-down = down

# Why a picture does not show a defect. The monitor sends and stores the English texts.
terms-picture-of-defect = defect { $defect }: { $reason }
terms-picture-not-central = not in the central 80% of the image
terms-picture-hidden = hidden behind something
terms-picture-too-oblique = too oblique: { $value } deg, limit { $limit } deg
terms-picture-too-small = too small: { $value } px, at least { $limit } px
terms-picture-line-too-thin = line too thin: { $value } px, at least { $limit } px
terms-picture-dark-lamp-on = too dark: lamp on, { $value } lx of { $limit } lx needed
terms-picture-dark-lamp-off = too dark: lamp off, { $value } lx of { $limit } lx needed
