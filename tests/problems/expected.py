"""How each answer of the sources (answers.json) is found in the solutions of the models.

answers.json holds, for each outside problem, what its source states: `expected` formulas in the symbols of the source, their
`numeric` values at the point `at`, the `report` that is demanded besides, and the `caveat` on misprints.  Every entry of it must
stand here or in NOT_ASKED with the reason, else the test fails.

An entry: where the value stands (letter, name of the value or name@unit vector, model if it is not that of the problem), and
  ours     what is compared with the source's formula; `value` is the value found, other names are those of the model
  names    names of the model in terms of those of the source, beside ALIAS
  set      parameters given to the model by --set"""

# names of the model -> names of the source
ALIAS = {
    "theta": "th", "theta_dot": "thd", "phi": "ph", "phi_dot": "phd", "psi": "ps", "psi_dot": "psd", "omega": "w", "alpha": "al",
    "rho_dot": "rhod", "r_dot": "rd", "x_dot": "xd", "y_dot": "yd", "z_dot": "zd", "theta_0": "th0", "x1_0": "x10", "x1_dot_0": "v10",
    "J": "I0", "phi0": "ph0", "theta0": "th0", "mu": "mu", "x_0": "x0", "r_0": "r0",
}


class At:
    def __init__(self, letter, name, ours="value", names=None, model=None, set=None, of=None, at=None, branch=None):
        self.letter, self.name, self.ours, self.names = letter, name, ours, names or {}
        self.model, self.set, self.of, self.at, self.branch = model, set or (), of, at, branch


class Simulated:
    """A number taken from an event of `pleuel sim --json` with the source's numbers set; `ours` in t and the state."""

    def __init__(self, event, ours="t", set=(), model=None, relative=1e-9, after=None):
        self.event, self.ours, self.set, self.model, self.relative, self.after = event, ours, set, model, relative, after


LADDER = ("m=10", "l=3", "α0=1.2")
SKIER = ("m=80", "R=10", "θ0=0.01")
ENTRIES = {
    "P01": {
        "la1": At("b", "lambda_rope"), "x1dd": At("b", "x1_ddot"), "x1_t": At("c", "x1"),
        "series_heavy": At("g", "x1_ddot/g"), "series_near": At("f", "x1_ddot/g", names={"m1": "m2+d"}),
    },
    "P02": {
        "x2": At("c", "x2", names={"phi": "phi"}), "J": At("c", "diff(diff(T, phi_dot), phi_dot)", names={"phi": "phi"}),
        "phidd": At("a", "phi_ddot", names={"phi": "phi", "phi_dot": "phid"}),
        "la1": At("b", "lambda_g1", names={"phi": "phi", "phi_dot": "phid"}),
        "la2": At("b", "lambda_g2", names={"phi": "phi", "phi_dot": "phid"}),
    },
    "P03": {
        "la1": At("b", "lambda_hill"), "thdd": At("b", "theta_ddot"), "la_path": At("c", "lambda_hill"), "th_j": At("d", "theta"),
        "v_j": At("e", "R*theta_dot"), "th_j_from_th0": At("f", "theta"), "t_liftoff_from_th0": Simulated("hill", set=SKIER),
    },
    "P04": {"la1": At("a", "lambda_plane"), "xdd": At("a", "x_ddot"), "absZ": At("b", "norm(force(plane))")},
    "P07": {
        "X1dd": At("b", "X1_ddot"), "ydd": At("b", "X2_ddot - Yp_ddot"), "la1": At("b", "lambda_rope1"), "la2": At("b", "lambda_rope2"),
    },
    "P09": {
        "rhodd": At("a", "rho_ddot"), "la2": At("b", "lambda_drive"), "w2_1": At("c", "omega^2"), "w_crit": At("c", "omega"),
    },
    "P10": {
        "thdd": At("b", "theta_ddot"), "la1": At("c", "lambda_hoop"), "la2": At("c", "lambda_drive"), "w_crit": At("e", "omega"),
        "th_eq": At("e", "equilibrium 3@theta"), "Om2_bottom": At("e", "omega^2", at="equilibrium 1", set=("ω=3",)),
        "Om2_tilted": At("e", "omega^2", at="equilibrium 3"),
    },
    "P12": {
        "rdd": At("a", "r_ddot"), "la1": At("b", "lambda_rod"), "r_t": At("c", "r", names={"r_dot_0": "0"}),
        "la_t": At("c", "lambda_rod", names={"r_dot_0": "0"}),
        "power": At("c", "dt(E)", names={"r": "r0*cosh(w*t)", "r_dot": "r0*w*sinh(w*t)"}),
    },
    "P14": {
        "thdd": At("a", "theta_ddot"), "la1": At("b", "lambda_touch"), "la2": At("c", "lambda_roll"), "cos_sep": At("d", "cos(theta)"),
    },
    "P16": {
        "thdd": At("a", "alpha_ddot", names={"alpha": "th", "l": "L"}),
        "la1": At("d", "lambda_wall", names={"alpha": "th", "alpha0": "th0", "l": "L"}),
        "sin_det": At("c", "sin(alpha)", names={"alpha0": "th0"}), "floor_det": At("c", "lambda_floor"),
        "vx_det": At("c", "x_dot", names={"alpha0": "th0", "l": "L"}),
        "t_det": Simulated("wall", set=LADDER), "t_floor": Simulated("down", set=LADDER),
    },
    "P18": {
        "cubic": At("b", "lambda_dome", ours="value*2*R*(M+m*(1-c^2))^2/(-M*m*g*(M+m))", names={"theta": "acos(c)"}),
        "th_sep_equal": At("c", "theta", model="P18_equal"),
        "th_sep_m_0.1M": At("c", "theta", set=("m=0.1", "M=1", "R=1")), "th_sep_m_5M": At("c", "theta", set=("m=5", "M=1", "R=1")),
    },
    "P19": {
        "xdd": At("a", "x_ddot"), "la1": At("a", "lambda_roll"), "la2": At("a", "lambda_plane"),
        "mu_min": At("b", "abs(lambda_roll)/lambda_plane"), "v_end": At("c", "x_dot"),
    },
    "P21": {
        "Xdd": At("a", "X_ddot"), "la1": At("a", "lambda_slope"), "a_rel": At("d", "(-X_ddot + x_ddot)/cos(alpha)"),
        "t_s": Simulated("end", set=("m=0.1", "M=0.431", "α=0.5934119456780721", "s=0.14")),
    },
    "P22": {"thdd": At("a", "theta_ddot"), "Xdd": At("a", "X_ddot"), "w2_1": At("c", "omega^2"), "w2_2": At("c", "omega^2")},
    "P26": {
        "thdd": At("a", "theta_ddot"), "Om2": At("d", "psi_dot^2"), "w2_1": At("e", "omega^2"), "la1": At("d", "lambda_string"),
    },
    "P28": {"phd0_2": At("c", "phi_dot^2"), "w2_1": At("d", "omega^2"), "la1": At("c", "lambda_bowl")},
    "P30": {"rdd": At("a", "r_ddot"), "la1": At("a", "lambda_string"), "phd0_2": At("c", "phi_dot^2"), "w2_1": At("d", "omega^2")},
    "P31": {
        "w2_1": At("b", "omega^2"), "w2_2": At("b", "omega^2"), "equal_plus": At("b", "omega^2", model="P31_equal"),
        "equal_minus": At("b", "omega^2", model="P31_equal"),
    },
    "P33": {
        "w2_1": At("a", "omega^2"), "w2_2": At("a", "omega^2"),
        "u_t": At("b", "u", names={"u_0": "A", "v_0": "0", "u_dot_0": "0", "v_dot_0": "0"}), "T_beat": At("a", "omega^2", ours="2*pi/(sqrt(w2_2)-sqrt(w2_1))"),
    },
    "P36": {
        "rdd": At("a", "r_ddot"), "thdd": At("a", "theta_ddot"), "r_eq": At("b", "equilibrium 1@r"), "w2_1": At("b", "omega^2"),
        "w2_2": At("b", "omega^2"), "k_res": At("d", "k"),
    },
    "P38": {"cos_eq": At("c", "cos(theta)"), "W_crit": At("c", "W", ours="value^2"), "w2_1": At("b", "omega^2")},
    "P40": {
        "x_exact": At("b", "x", names={"A": "A"}, model="P40_angle"), "a_exact": At("b", "x_ddot", names={"t": "A/w"}),
        "a_approx": At("c", "x_ddot", names={"epsilon": "R/L", "t": "A/w"}), "A0_approx": At("c", "A", model="P40_angle"),
        "s_at_A0": At("d", "L + R - x", names={"epsilon": "R/L"}, model="P40_angle"),
        "A0_exact_deg": At("d", "omega*t", ours="value*180/pi", set=("R=0.1", "L=0.2", "ω=1")),
    },
    "P43": {
        "ydd": At("a", "y_ddot"), "zdd": At("a", "z_ddot"),
        "y_t": At("c", "y", names={"y_0": "0", "z_0": "0", "y_dot_0": "0", "z_dot_0": "0"}),
        "z_t": At("c", "z", names={"y_0": "0", "z_0": "0", "y_dot_0": "0", "z_dot_0": "0"}), "drift": At("d", "y_dot"),
    },
    "P45": {"thdd": At("a", "theta_ddot"), "P_diss": At("b", "dt(E)"), "om_d": At("c", "omega_d"), "k_crit": At("d", "k")},
    "P47": {
        "thdd": At("b", "theta_ddot", names={"x_dot": "v*cos(th)", "y_dot": "v*sin(th)", "theta_dot": "w"}),
        "la1": At("b", "lambda_blade", names={"x_dot": "v*cos(th)", "y_dot": "v*sin(th)", "theta_dot": "w"}),
        "v_t": Simulated("mark", "x_dot*cos(theta)+y_dot*sin(theta)", set=("m=2", "J=0.3", "a=0.4", "V=1.5")),
        "w_t": Simulated("mark", "theta_dot", set=("m=2", "J=0.3", "a=0.4", "V=1.5")),
    },
    "P48": {
        "thdd": At("b", "theta_ddot"), "phdd": At("b", "phi_ddot"), "la1": At("b", "lambda_rx", names={"theta_dot": "w", "phi_dot": "W"}),
        "la2": At("b", "lambda_ry", names={"theta_dot": "w", "phi_dot": "W"}),
        "rho": At("c", "sqrt(x_dot^2 + y_dot^2)/phi_dot",
                  names={"x_dot": "R*w*cos(ph)", "y_dot": "R*w*sin(ph)", "phi_dot": "W", "theta_dot": "w"}),
    },
    "P49": {
        "thdd": At("a", "theta_ddot"),
        "x_t": Simulated("mark", "x", set=("m=0.02", "r=0.012", "α=0.3", "w=2")),
        "y_t": Simulated("mark", "y", set=("m=0.02", "r=0.012", "α=0.3", "w=2")),
        "x_max": Simulated("top", "x", set=("m=0.02", "r=0.012", "α=0.3", "w=2")),
    },
    "P52": {
        "xdd": At("a", "x_ddot"), "x_t": At("a", "x", names={"x_dot_0": "0"}), "t_end": Simulated("edge", set=("L=1", "x0=0.1")),
        "v_end": At("c", "x_dot"), "x_lift": At("d", "x"), "s_crit_friction": At("e", "x"),
    },
    "P54": {
        "la1": At("a", "lambda_string", model="P54_cartesian",
                  names={"x": "l*sin(th)", "y": "-l*cos(th)", "x_dot": "l*cos(th)*thd", "y_dot": "l*sin(th)*thd"}),
        "cos_slack": At("b", "cos(theta)", ours="-value"), "v_slack": At("c", "l*theta_dot"),
        "t_slack": Simulated("string", set=("l=2.85", "u=9.892155983404225")),
        "t_taut": Simulated("string", after="string", set=("l=2.85", "u=9.892155983404225")),
        "u2_through_O": Simulated("centre", "10.214819748943906^2+y*9.81", set=("u=10.214819748943906",), model="P54_cartesian"),
    },
    "P58": {"rdd": At("a", "r_ddot"), "r_t": At("a", "r")},
    "P59": {
        "sum": At("b", "lambda_left + lambda_mid + lambda_right"), "diff": At("b", "-lambda_left + lambda_right"),
        "min_norm": At("b", "lambda_mid", branch="minimum norm"),
    },
    "P62": {"y_hidden": At("b", "y"), "w2_1": At("b", "omega^2")},
    "P64": {
        "thdd": At("a", "theta_ddot"), "la2": At("b", "lambda_floor"), "w0_min": At("c", "theta_dot"),
        "w0_min_liftoff": At("c", "theta_dot"), "N_massless": At("b", "lambda_floor", model="P64_massless"),
        "th_hop_massless": At("c", "theta", model="P64_massless"),
    },
    "P65": {"la1": At("b", "lambda_string"), "phdd": At("d", "phi_ddot")},
    "P69": {
        "la1": At("a", "lambda_rod", model="P69_angles"), "psdd": At("a", "psi_ddot", model="P69_angles"), "dof": At("a", "dof"),
    },
}

# What no request gives, with the reason.
NOT_ASKED = {
    ("P10", "T_times_A_times_wc"): "a limit of periods: quadrature of an elliptic integral, an analysis of a later version",
    ("P64", "th_at_w0_min"): "the angle 0 is the condition under which w0_min is asked",
}

# Degrees of freedom where the source counts them: of position, of velocity.
FREEDOM = {"P01": (1, 1), "P07": (2, 2), "P59": (1, 1), "P62": (1, 1), "P69": (3, 3), "P26": (2, 2), "P48": (4, 2), "P47": (3, 2)}
