### Scenario editor: placing defects on the drawings.

placing-title = Place defects
placing-note = Choose a defect, then click a drawing of a bridge. Placed defects replace the random ones: as soon as you place one, the random ones of this scenario are gone.
placing-kind = Defect
placing-state = Condition state
placing-state-2 = 2: fair
placing-state-3 = 3: poor
placing-state-4 = 4: severe
placing-length = Length (m)
placing-width = Width (mm)
placing-turn = Rotation (°)
placing-size-note = If you leave the size empty, the defect gets a typical size for its condition state. The rotation is counterclockwise, seen from outside.
placing-surface = Surface
placing-surface-front = Facing the viewer: top in the plan, near side in a side view
placing-surface-back = Facing away: underside in the plan, far side in a side view
placing-on-drawing = Place on a drawing
placing-coordinates = At coordinates (m)
placing-coordinates-note = On the nearest surface of a bridge, at most { $most } m away.
placing-at-coordinates = Place at the coordinates
placing-list = Placed defects ({ $count })
placing-none = None. The defects are placed at random.
placing-entry = { $number }: { $kind }, condition state { $state }, { $member }
placing-remove = Remove defect { $number }
placing-mark = Defect { $number }: { $kind }, condition state { $state }
placing-script-click = Click the site plan or a side view. Press Escape to cancel.
placing-done = Defect { $number } was placed on { $member } ({ $element }).

# Reasons why a defect was not placed.
placing-not-placed = Not placed: { $reason }
placing-invalid-scenario = the scenario has problems. Correct them first.
placing-number = { $field }: not a number from { $low } to { $high }.
placing-width-over-length = the width is larger than the length.
placing-other-state = with this size, the condition state is { $state }.
placing-too-many = there are already { $most } placed defects: remove one first.
placing-no-bridge = there is no bridge at this point of the drawing.
placing-off-surface = the nearest surface of a bridge is { $distance } m away (allowed: at most { $most } m).
placing-not-permitted = '{ $kind }' does not occur on this element ({ $element }). Possible here: { $kinds }.
placing-nothing-permitted = no defects occur on this element ({ $element }).
placing-too-large = the defect would reach beyond its surface. Make it smaller, or place it farther from the edge.
placing-covered = another part of the bridge covers this place.
