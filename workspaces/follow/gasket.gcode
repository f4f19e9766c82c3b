G21 G90
; The outline, with two round and two sharp corners.
G0 X280 Y-60
G1 X370 F12000
G3 X390 Y-40 J20
G1 Y40
G3 X370 Y60 I-20
G1 X280
Y-60
; The hole.
G0 X360 Y0
G3 I-25
M2
