; Labels on two trays, in millimetres. Z is the height of the pen.
G21 G90
G0 Z5
G0 X200 Y250     ; a frame on the right tray
G1 Z0 F600
G1 X280 F3000
G1 Y300
G1 X200
G1 Y250
G0 Z5
G0 X-280 Y250    ; the same frame on the left tray
G1 Z0 F600
G1 X-200 F3000
G1 Y300
G1 X-280
G1 Y250
G0 Z5
G0 X240 Y265     ; a circle on the right tray
G1 Z0 F600
G3 J10 F3000
G0 Z5
G91
G0 X-480         ; and on the left tray, from where the pen is
G1 Z-5 F600
G3 J10 F3000
G90
G0 Z5
M2
