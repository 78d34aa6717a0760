"""The beams of the designs beam_at_end and beam_inside, and (βL)² = ω √(μL⁴/EI) of beams held in various ways.

clamped–free 3.516…, free–free 22.373…, pinned–free 15.418… from cos βL cosh βL = ∓1 and tan βL = tanh βL; the designs'
√(EI/μL⁴) is 5 rad/s.
"""

UNIT = 5.0  # rad/s
LENGTH, BENDING_RIGIDITY = 2.0, 4000.0  # of these designs [m, N·m²]
CLAMPED_FREE = [3.51601527, 22.03449156, 61.69721441]
FREE_FREE = [22.37328545, 61.67282287, 120.90339173]
PINNED_FREE = [15.41820572, 49.96486203, 104.24769646]
GUIDED_FREE = [5.59332, 30.22585, 74.63888]  # tan βL + tanh βL = 0
