// A portal in general pose: a straight rail, an arched post (point 4 is the arc's centre) and a brace.
Point(1) = {0.3, 0.1, 0.7};
Point(2) = {1.7, 0.4, 0.7};
Point(3) = {1.2, -0.8, 0.7};
Point(4) = {0.85, 0.05, 0.7};
Line(1) = {1, 2};
Circle(2) = {2, 4, 3};
Line(3) = {1, 3};
Transfinite Curve {1} = 4;
Transfinite Curve {2} = 5;
Transfinite Curve {3} = 3;
Physical Curve("rail") = {1};
Physical Curve("post") = {2, -3};
Physical Point("left") = {1};
Physical Point("foot") = {3};
