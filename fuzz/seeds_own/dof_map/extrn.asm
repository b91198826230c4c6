BEGIN SUPER=100
EXTRN          1     123
EXTRN,4,0
GRID           1       0      0.      0.      0.       0
SPOINT         4
ENDDATA
