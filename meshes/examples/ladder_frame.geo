// Side frame of a trailer in its own plane: two rails of 6 m, 0.8 m apart, joined by seven posts.
SetFactory("Built-in");
length = 6.0;
height = 0.8;
bays = 6;
For i In {0:bays}
  Point(1 + i) = {i * length / bays, 0, 0};
  Point(101 + i) = {i * length / bays, height, 0};
  Line(201 + i) = {1 + i, 101 + i};
EndFor
For i In {1:bays}
  Line(i) = {i, i + 1};
  Line(100 + i) = {100 + i, 101 + i};
EndFor
Transfinite Curve {1:bays, 101:100 + bays} = 5;
Transfinite Curve {201:201 + bays} = 4;
Physical Curve("rail") = {1:bays, 101:100 + bays};
Physical Curve("post") = {201:201 + bays};
Physical Point("kingpin") = {2};
Physical Point("axle") = {5};
Physical Point("rear_end") = {7};
