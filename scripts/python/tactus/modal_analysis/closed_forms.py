"""Natural frequencies of ideal bodies, from the literature and independent of the renderer."""
import math


def free_bar_roots(count):
    """Positive roots of cos x cosh x = 1: free-free bending of a bar (Fletcher and Rossing, The Physics of Musical Instruments, 2nd ed.,
    section 2.9), by bisection of cos x - 1 / cosh x."""
    roots = []
    for n in range(count):
        low, high = (n + 1) * math.pi + 0.1, (n + 2) * math.pi - 0.1
        value = lambda x: math.cos(x) - 1 / math.cosh(x)
        for _ in range(80):
            middle = (low + high) / 2
            low, high = (middle, high) if value(low) * value(middle) > 0 else (low, middle)
        roots.append(low)
    return roots


def euler_bernoulli_Hz(material, length_m, thickness_m, root):
    """Fletcher and Rossing, eq. 2.63, with the radius of gyration h / sqrt(12) of a rectangle."""
    speed = math.sqrt(material["youngs_modulus_Pa"] / material["density_kg_m3"])
    return (root / length_m) ** 2 * thickness_m / math.sqrt(12) * speed / (2 * math.pi)


def free_bar_Hz(material, length_m, thickness_m, count):
    """The same with shear and rotary inertia to first order (Graff, Wave Motion in Elastic Solids, 1975, section 3.4), E / G = 2 (1 + nu),
    kappa = 5/6. The correction of the lowest mode of a bar 60 times as long as thick is 0.1 %, and larger for higher modes."""
    shear = 2 * (1 + material["poissons_ratio"]) / (5 / 6)
    found = []
    for root in free_bar_roots(count):
        slender = (root / length_m * thickness_m) ** 2 / 12
        found.append(euler_bernoulli_Hz(material, length_m, thickness_m, root) / math.sqrt(1 + slender * (1 + shear)))
    return found


def free_bar_shape(root, place):
    """Displacement at `place`, 0 .. 1 of the length: cosh + cos - q (sinh + sin)."""
    q = (math.cosh(root) - math.cos(root)) / (math.sinh(root) - math.sin(root))
    x = root * place
    return math.cosh(x) + math.cos(x) - q * (math.sinh(x) + math.sin(x))


def free_bar_node(root):
    """The nodal point nearest to the end, 0 .. 1 of the length."""
    low, high = 0.0, 1e-3
    while free_bar_shape(root, high) > 0:
        low, high = high, high + 1e-3
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if free_bar_shape(root, middle) > 0 else (low, middle)
    return low


def supported_plate_Hz(material, a_m, b_m, thickness_m, below_Hz):
    """{(m, n): frequency}: the bending wave of wavenumber k = pi sqrt(m^2 / a^2 + n^2 / b^2) (Leissa, Vibration of Plates, NASA SP-160,
    1969, eq. 4.20), with shear and rotary inertia (Mindlin, J. Appl. Mech. 18, 1951, p. 31), kappa = 5/6: the lower root w^2 of
    (k^2 - w^2 / c_s^2) (D k^2 - rho h^3 w^2 / 12) = rho h w^2, c_s^2 = kappa G / rho."""
    rho, nu, h = material["density_kg_m3"], material["poissons_ratio"], thickness_m
    rigidity = material["youngs_modulus_Pa"] * h ** 3 / (12 * (1 - nu ** 2))
    shear = 5 / 6 * material["youngs_modulus_Pa"] / (2 * (1 + nu)) / rho

    def frequency(m, n):
        k2 = math.pi ** 2 * ((m / a_m) ** 2 + (n / b_m) ** 2)
        a, b, c = rho * h ** 3 / (12 * shear), rho * h + k2 * (rho * h ** 3 / 12 + rigidity / shear), rigidity * k2 ** 2
        return math.sqrt(2 * c / (b + math.sqrt(b * b - 4 * a * c))) / (2 * math.pi)

    every = {(m, n): frequency(m, n) for m in range(1, 60) for n in range(1, 60)}
    return {k: f for k, f in sorted(every.items(), key=lambda item: item[1]) if f < below_Hz}


def spherical_shell_Hz(material, radius_m, orders):
    """Thin spherical shell, membrane theory, lower branch (Baker, J. Acoust. Soc. Am. 33, 1961, p. 1749; Blevins, Formulas for Natural
    Frequency and Mode Shape, 1979, table 12-2): O^4 - (1 + 3 nu + n (n + 1)) O^2 + (1 - nu^2) (n (n + 1) - 2) = 0."""
    nu = material["poissons_ratio"]
    speed = math.sqrt(material["youngs_modulus_Pa"] / (material["density_kg_m3"] * (1 - nu ** 2)))
    found = []
    for n in orders:
        b, c = 1 + 3 * nu + n * (n + 1), (1 - nu ** 2) * (n * (n + 1) - 2)
        found.append(math.sqrt(2 * c / (b + math.sqrt(b * b - 4 * c))) * speed / (2 * math.pi * radius_m))
    return found


def damping_1_s(material, frequency_Hz):
    """Rayleigh: d = (alpha + beta w^2) / 2."""
    return (material["rayleigh_alpha_1_s"] + material["rayleigh_beta_s"] * (2 * math.pi * frequency_Hz) ** 2) / 2
