; A frame with round corners, a slot and a circle, in millimetres.
G21 G90 G17
F6000           ; 100 mm/s
G0 X1100 Y-150
G1 X1280
G3 X1300 Y-130 J20
G1 Y130
G3 X1280 Y150 I-20
G1 X1120
G3 X1100 Y130 J-20
G1 Y-150
G0 X1150 Y-60   ; the slot
G1 X1250
G2 Y-40 J10
G1 X1150
G0 X1250 Y60    ; the circle
F3000           ; 50 mm/s
G3 I-50
M2
