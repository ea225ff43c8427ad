"""Transport relations q*(tau*) and the drag of a sphere from the literature, and the numbers Zhang et al. (2022)
print."""
import numpy as np


def excess_power(shields, prefactor, threshold):
    """prefactor (tau* - threshold)^1.5, zero below the threshold."""
    return prefactor * np.maximum(np.asarray(shields, float) - threshold, 0.0)**1.5


def meyer_peter_mueller(shields):
    """Meyer-Peter and Mueller (1948)."""
    return excess_power(shields, 8.0, 0.047)


def wong_parker(shields):
    """Wong and Parker (2006), the same data with a better correction for side walls."""
    return excess_power(shields, 3.97, 0.0495)


def fernandez_luque_van_beek(shields, threshold=0.0455):
    """Fernandez Luque and van Beek (1976); thresholds from 0.037 to 0.0455."""
    return excess_power(shields, 5.7, threshold)


# Of their curve below: what the paper's own two-phase continuum has at its 18 points, by least squares
# (benchmarks/validation/continuum); single points need 3.8 to 8.3.
CONTINUUM_PREFACTOR = 6.8


def zhang_wide_bed(shields, prefactor=1.0):
    """The curve of Zhang et al. (2022), fig. 6, for beds without side walls: q* = (tau* - 0.033)^1.5, as printed.

    With that prefactor the curve is a factor of 3 to 8 below the relations above and below the paper's own flume, so
    one between 5 and 8 seems to be missing. Do not take it as a reference before the figure's data have been read.
    """
    return excess_power(shields, prefactor, 0.033)


def paehtz_duran(shields, threshold=0.033):
    """Pähtz and Durán (2020, Phys. Rev. Lett. 124, 168001): from the energy that grains lose in the bed and to each other,
    with kappa = 0.4, a friction coefficient of the bed of 0.63 and a coefficient of collisions of 1.7, none of which is
    fitted to transport rates in water. threshold: the Shields number at which transport ceases; by default that of
    Zhang et al. for beds without side walls.
    """
    load = np.maximum(np.asarray(shields, float) - threshold, 0.0) / 0.63   # of moving grains, per area
    return 2.0 * np.sqrt(threshold) / 0.4 * load * (1.0 + 1.7 * load)


def old_relations(shields):
    """The least and the most of the relations fitted to flumes: Meyer-Peter and Mueller, Wong and Parker, Fernandez Luque
    and van Beek with both thresholds."""
    values = [meyer_peter_mueller(shields), wong_parker(shields), fernandez_luque_van_beek(shields),
              fernandez_luque_van_beek(shields, 0.037)]
    return np.min(values, axis=0), np.max(values, axis=0)


# Zhang et al. (2022), sec. 2.2: the flume. What is not printed in the text is only in its figures.
FLUME_THRESHOLD, FLUME_THRESHOLD_ERROR = 0.026, 0.002   # of the experiment, Benavides et al.
# (Shields number, q*, standard deviation of q* over the last 10 s, start)
FLUME_POINTS = ((0.028, 0.089, 0.019, "standard"), (0.028, 0.077, 0.017, "faster flow"))
# (Shields number, standard deviation of q* over its mean)
FLUME_SCATTER = ((0.047, 0.16), (0.063, 0.11), (0.068, 0.09))


def flume_band():
    """q* at a Shields number of 0.028 from the standard start, mean less and plus one standard deviation."""
    _, mean, deviation, _ = FLUME_POINTS[0]
    return mean - deviation, mean + deviation


def schiller_naumann_drag(reynolds):
    """Drag coefficient of a sphere (Schiller and Naumann 1933): 24 (1 + 0.15 Re^0.687)/Re below Re = 1000, 0.44
    beyond."""
    return 24.0 / reynolds * (1.0 + 0.15 * reynolds**0.687) if reynolds < 1000.0 else 0.44


# Direct numerical simulation of an open channel over one layer of spheres on a square lattice: u* d/nu, height of the
# surface above the floor in diameters, Reynolds number of the flow rate per width (their abstract), and mean velocity
# in u* over the depth from 0.8 diameters above the floor on. M. Mazzuoli, M. Uhlmann, J. Fluid Mech. 824 (2017) 722.
SPHERE_CHANNEL_NUMBER, SPHERE_CHANNEL_HEIGHT, SPHERE_CHANNEL_FLOW_RATE = 120.0, 5.5, 6900.0
SPHERE_CHANNEL_MEAN = SPHERE_CHANNEL_FLOW_RATE / (SPHERE_CHANNEL_NUMBER * (SPHERE_CHANNEL_HEIGHT - 0.8))


def settling_speed(diameter, density_ratio, gravity, viscosity):
    """m/s: of a sphere alone in an unbounded fluid at rest, by that drag. SI units; found by bisection."""
    low, high = 0.0, 1e3 * np.sqrt(gravity * diameter)
    for _ in range(200):
        speed = 0.5 * (low + high)
        weight = 4.0 / 3.0 * (density_ratio - 1.0) * gravity * diameter
        low, high = (
            (low, speed) if schiller_naumann_drag(speed * diameter / viscosity) * speed**2 > weight else (speed, high)
        )
    return 0.5 * (low + high)


def beetstra_drag(phi, reynolds):
    """Mean drag on a sphere of an array over Stokes' drag, without the mean pressure gradient; phi: solid fraction,
    reynolds: of the superficial velocity and the diameter. R. Beetstra, M. A. van der Hoef, J. A. M. Kuipers, AIChE J.
    53 (2007) 489; for slow flow the law of M. A. van der Hoef et al., J. Fluid Mech. 528 (2005) 233."""
    gap = 1.0 - phi
    slow = 10.0 * phi / gap**2 + gap**2 * (1.0 + 1.5 * np.sqrt(phi))
    fast = (1.0 / gap + 3.0 * phi * gap + 8.4 * reynolds**-0.343) / (
        1.0 + 10.0 ** (3.0 * phi) * reynolds ** (-0.5 - 2.0 * phi)
    )
    return slow + 0.413 * reynolds / (24.0 * gap**2) * fast


def tenneti_drag(phi, reynolds):
    """The same by S. Tenneti, R. Garg, S. Subramaniam, Int. J. Multiphase Flow 37 (2011) 1072; times 1 - phi, since
    their force contains the mean pressure gradient."""
    gap = 1.0 - phi
    alone = 1.0 + 0.15 * reynolds**0.687
    slow = 5.81 * phi / gap**3 + 0.48 * phi**(1.0 / 3.0) / gap**4
    fast = phi**3 * reynolds * (0.95 + 0.61 * phi**3 / gap**2)
    return gap * (alone / gap**3 + slow + fast)
