"""Impacts of a sphere in a fluid, as the scripts on rebounds count them."""
import math

CONTACT_GAP = 0.02        # diameters: closer than this, a turn is an impact
IMPACTS = 3


def settling_time(case):
    """Time (s) that sound takes around the first grain of a case, pi R/c_s; before it the fluid cannot respond to a
    rebound."""
    radius, spacing = 0.5 * case["grains"][0]["diameter"], case["domain"]["spacing"]
    return math.pi * radius * math.sqrt(3.0) * case["fluid"]["time_step"] / spacing


def impacts(times, gaps, velocities, answer):
    """Velocities before and after each of the first impacts, positive: the largest since the last impact, and that at
    the time `answer` (s) after the contact. gaps: diameters; velocities: m/s, away from the other body. The fall from
    the start counts from two diameters on; a body that begins at the other one and leaves it has not met it."""
    begin, found = next(k for k, gap in enumerate(gaps) if gap < 2.0), []
    begin = next((k for k in range(begin, len(gaps)) if velocities[k] < 0.0), len(gaps))
    while len(found) < IMPACTS:
        near = next((k for k in range(begin, len(gaps)) if gaps[k] < CONTACT_GAP), len(gaps))
        left = next((k for k in range(near + 1, len(gaps)) if velocities[k] > 0.0), len(gaps))
        later = next((k for k in range(left, len(gaps)) if times[k] >= times[left] + answer), None)
        if later is None:
            break
        share = (times[left] + answer - times[later - 1]) / (times[later] - times[later - 1])
        after = velocities[later - 1] + share * (velocities[later] - velocities[later - 1])
        found.append((max(-v for v in velocities[begin:near + 1]), max(0.0, after)))
        begin = next((k for k in range(left, len(gaps)) if velocities[k] < 0.0), len(gaps))
    return found
