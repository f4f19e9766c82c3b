"""Writes workspaces/drawings/cell.dxf: python make_cell.py cell.dxf (ezdxf 1.4)."""
import math, sys
import ezdxf
from ezdxf import units

doc = ezdxf.new("R2010", units=units.MM)
for name, color in [("robot", 3), ("conveyor", 5), ("fence", 1), ("fixtures", 6), ("notes", 8), ("old", 9)]:
    doc.layers.add(name, color=color)
doc.layers.get("old").freeze()
msp = doc.modelspace()
# The base of the robot: a plate with rounded corners, by bulges.
b = math.tan(math.pi / 8)
def rounded(x0, y0, x1, y1, r):
    return [(x0 + r, y0, 0, 0, 0), (x1 - r, y0, 0, 0, b), (x1, y0 + r, 0, 0, 0), (x1, y1 - r, 0, 0, b),
            (x1 - r, y1, 0, 0, 0), (x0 + r, y1, 0, 0, b), (x0, y1 - r, 0, 0, 0), (x0, y0 + r, 0, 0, b)]
msp.add_lwpolyline(rounded(-200, -200, 200, 200, 60), close=True, dxfattribs={"layer": "robot"})
# The conveyor: a belt with round ends, 900 mm high.
msp.add_lwpolyline([(500, 750, 0, 0, 0), (1900, 750, 0, 0, 1), (1900, 1150, 0, 0, 0), (500, 1150, 0, 0, 1)], close=True,
                   dxfattribs={"layer": "conveyor", "thickness": 900})
# The fence: lines and an arc that join, open at the door.
a = {"layer": "fence"}
msp.add_line((-1500, -900), (-1500, 1500), dxfattribs=a)
msp.add_line((-1500, 1500), (2100, 1500), dxfattribs=a)
msp.add_line((2400, 1200), (2400, -1500), dxfattribs=a)
msp.add_arc((2100, 1200), 300, 0, 90, dxfattribs=a)
msp.add_line((2400, -1500), (-900, -1500), dxfattribs=a)
# A feeder as a block: a hopper of four lines, and a round bowl; placed twice.
feeder = doc.blocks.new("feeder")
for p, q in [((0, 0), (360, 0)), ((360, 0), (360, 240)), ((360, 240), (0, 240)), ((0, 240), (0, 0))]:
    feeder.add_line(p, q)
feeder.add_circle((180, 390), 120)
msp.add_blockref("feeder", (-1260, 450), dxfattribs={"layer": "fixtures"})
msp.add_blockref("feeder", (1500, -500), dxfattribs={"layer": "fixtures", "rotation": 90, "xscale": 0.8, "yscale": 0.8})
# A post, and a tray that is an ellipse.
msp.add_circle((-750, -840), 100, dxfattribs={"layer": "fixtures"})
msp.add_ellipse((500, -1140), major_axis=(300, 0), ratio=0.5, dxfattribs={"layer": "fixtures"})
# Entities that no arm can meet.
msp.add_text("CELL 7", dxfattribs={"layer": "notes", "height": 75}).set_placement((-1440, 1380))
msp.add_linear_dim(base=(0, 1700), p1=(-1500, 1500), p2=(2400, 1500), dxfattribs={"layer": "notes"}).render()
hatch = msp.add_hatch(color=2, dxfattribs={"layer": "notes"})
hatch.paths.add_polyline_path([(500, 750), (1900, 750), (1900, 1150), (500, 1150)])
msp.add_circle((0, 0), 1200, dxfattribs={"layer": "old"})
doc.saveas(sys.argv[1])
# Of the variables of the header, only these differ from the defaults that a reader assumes.
kept = {"$ACADVER", "$DWGCODEPAGE", "$HANDSEED", "$MEASUREMENT", "$INSUNITS"}
head, mark, rest = open(sys.argv[1]).read().partition("  0\nENDSEC\n")
begin, *variables = head.split("  9\n")
with open(sys.argv[1], "w") as file:
    file.write("  9\n".join([begin, *(text for text in variables if text.split("\n")[0] in kept)]) + mark + rest)
