"""Outside problems with answers from the literature, each in the symbols of its source.  Sources: the standard collections named
at each problem.  An entry: letter of the request, name of the value (or name@unit vector of a component), the source's formula."""

# names of the source -> names of the model
ALIAS = {
    "th": "theta", "thd": "theta_dot", "ph": "phi", "phd": "phi_dot", "psd": "psi_dot", "ps": "psi", "w": "omega", "al": "alpha",
    "rhod": "rho_dot", "rd": "r_dot", "xd": "x_dot", "yd": "y_dot", "zd": "z_dot", "ud": "u_dot", "vd": "v_dot", "th0": "theta_0",
    "d": "d", "I0": "J", "B0": "B0", "x1d": "x1_dot", "y1d": "y1_dot", "x2d": "x2_dot", "y2d": "y2_dot", "phid": "phi_dot",
}

# problem, what it is, source, entries
PROBLEMS = [
    ("P01", "Atwood machine", "university problem sheet, theoretical mechanics I", [
        ("b", "lambda_rope", "-2*g*m1*m2/(m1+m2)"),
        ("b", "x1_ddot", "(m1-m2)/(m1+m2)*g"),
        ("c", "x1", "x1_0+x1_dot_0*t+(m1-m2)/(m1+m2)*g*t^2/2"),
        ("e", "x1_ddot series", "g*(1-2*m2/m1)"),
        ("f", "x1_ddot", "g*(d/(2*m2)-d^2/(4*m2^2))"),
    ]),
    ("P02", "slider-crank under gravity", "university problem sheet, theoretical mechanics I", [
        ("a", "phi_ddot", "-(m2*r^2*(sin(phi)*cos(phi)*(1-r*cos(phi)/sqrt(l^2-r^2*sin(phi)^2))^2+sin(phi)^2*(1-r*cos(phi)/sqrt(l^2-r^2*sin(phi)^2))"
         "*r*sin(phi)*(l^2-r^2)/(l^2-r^2*sin(phi)^2)^(3/2))*phid^2+m1*g*r*cos(phi))/(m1*r^2+m2*r^2*sin(phi)^2*(1-r*cos(phi)/sqrt(l^2-r^2*sin(phi)^2))^2)"),
    ]),
    ("P03", "skier leaving a quarter circle", "university problem sheet, theoretical mechanics I", [
        ("b", "lambda_hill", "m*g*cos(th)-m*R*thd^2"),
        ("b", "theta_ddot", "g/R*sin(th)"),
        ("c", "lambda_hill", "m*g*(3*cos(th)-2)"),
        ("d", "theta", "acos(2/3)"),
        ("e", "R*theta_dot", "sqrt(2*g*R/3)"),
    ]),
    ("P04", "inclined plane", "standard texts", [
        ("a", "lambda_plane", "m*g*cos(al)^2"),
        ("a", "x_ddot", "-g*sin(al)*cos(al)"),
        ("b", "Z@e_z", "m*g*cos(al)^2"),
        ("b", "Z@e_x", "-m*g*cos(al)*sin(al)"),
    ]),
    ("P07", "compound Atwood machine", "standard texts", [
        ("b", "X1_ddot", "g*(m1*(m2+m3)-4*m2*m3)/(m1*(m2+m3)+4*m2*m3)"),
        ("b", "X2_ddot - Yp_ddot", "2*g*m1*(m2-m3)/(m1*(m2+m3)+4*m2*m3)"),
        ("b", "lambda_rope1", "-8*g*m1*m2*m3/(m1*(m2+m3)+4*m2*m3)"),
        ("b", "lambda_rope2", "-4*g*m1*m2*m3/(m1*(m2+m3)+4*m2*m3)"),
    ]),
    ("P09", "bead on a rotating parabola", "standard texts", [
        ("a", "rho_ddot", "(rho*w^2-4*k^2*rho*rhod^2-2*k*g*rho)/(1+4*k^2*rho^2)"),
        ("b", "lambda_drive", "2*m*w*rho*rhod"),
        ("c", "omega^2", "2*g*k-w^2"),
    ]),
    ("P10", "bead on a hoop rotating about its diameter", "standard texts", [
        ("b", "theta_ddot", "w^2*sin(th)*cos(th)-g/R*sin(th)"),
        ("c", "lambda_hoop", "-m*R*(thd^2+w^2*sin(th)^2)-m*g*cos(th)"),
        ("c", "lambda_drive", "2*m*R^2*w*thd*sin(th)*cos(th)"),
        ("e", "omega^2", "w^2-g^2/(R^2*w^2)"),
    ]),
    ("P12", "bead on a rotating rod", "exercise collections", [
        ("a", "r_ddot", "w^2*r"),
        ("b", "lambda_rod", "2*m*w*rd"),
        ("c", "r", "r_0*cosh(w*t)+r_dot_0*sinh(w*t)/w"),
    ]),
    ("P14", "sphere rolling off an equal sphere", "standard texts", [
        ("a", "theta_ddot", "g*sin(th)/((1+k)*(R+a))"),
        ("b", "lambda_touch", "m*g*((3+k)*cos(th)-2)/(1+k)"),
        ("c", "lambda_roll", "k/(1+k)*m*g*sin(th)"),
        ("d", "cos(theta)", "2/(3+k)"),
    ]),
    ("P16", "ladder sliding off a wall", "standard texts", [
        ("a", "alpha_ddot", "-3*g/(2*l)*cos(alpha)"),
        ("c", "sin(alpha)", "2/3*sin(alpha_0)"),
    ]),
    ("P18", "particle on a movable hemisphere", "standard texts", [
        ("a", "p_X", "(M+m)*X_dot+m*R*theta_dot*cos(theta)"),
    ]),
    ("P19", "rolling down an incline", "standard texts", [
        ("a", "x_ddot", "g*sin(al)/(1+k)"),
        ("a", "lambda_roll", "-k/(1+k)*m*g*sin(al)"),
        ("a", "lambda_plane", "m*g*cos(al)"),
    ]),
    ("P21", "block on a movable wedge", "standard texts", [
        ("a", "X_ddot", "-m*g*sin(al)*cos(al)/(M+m*sin(al)^2)"),
        ("a", "lambda_slope", "M*m*g*cos(al)/(M+m*sin(al)^2)"),
    ]),
    ("P22", "pendulum on a cart", "standard texts", [
        ("a", "theta_ddot", "-((M+m)*g*sin(th)+m*l*thd^2*sin(th)*cos(th))/(l*(M+m*sin(th)^2))"),
        ("a", "X_ddot", "m*sin(th)*(l*thd^2+g*cos(th))/(M+m*sin(th)^2)"),
        ("c", "omega^2", "(M+m)*g/(M*l)"),
        ("c", "omega^2", "0"),
    ]),
    ("P26", "spherical pendulum", "standard texts", [
        ("a", "theta_ddot", "psd^2*sin(th)*cos(th)-g/l*sin(th)"),
        ("b", "lambda_string", "-m*l*thd^2-m*l*psd^2*sin(th)^2-m*g*cos(th)"),
    ]),
    ("P28", "particle on a paraboloid", "standard texts", [
        ("b", "lambda_bowl", "m*(rho^2*phd^2+rhod^2+2*a*g)/(2*(rho^2+4*a^2))"),
    ]),
    ("P30", "two masses joined through a hole", "standard texts", [
        ("a", "r_ddot", "(m*r*phd^2-M*g)/(m+M)"),
        ("a", "lambda_string", "-m*M/(m+M)*(g+r*phd^2)"),
    ]),
    ("P31", "plane double pendulum, modes", "Landau and Lifshitz, Mechanics", [
        ("b", "omega^2", "(M+m)/(2*M)*(g/L+g/l)+sqrt(((M+m)/(2*M)*(g/L+g/l))^2-(M+m)*g^2/(M*L*l))"),
        ("b", "omega^2", "(M+m)/(2*M)*(g/L+g/l)-sqrt(((M+m)/(2*M)*(g/L+g/l))^2-(M+m)*g^2/(M*L*l))"),
    ]),
    ("P33", "coupled pendulums", "standard texts", [
        ("a", "omega^2", "g/l"),
        ("a", "omega^2", "g/l+2*k/m"),
        ("b", "u", "(u_0-v_0)/2*cos(sqrt(g/l+2*k/m)*t)+(u_0+v_0)/2*cos(sqrt(g/l)*t)+(u_dot_0-v_dot_0)/2*sin(sqrt(g/l+2*k/m)*t)/sqrt(g/l+2*k/m)"
         "+(u_dot_0+v_dot_0)/2*sin(sqrt(g/l)*t)/sqrt(g/l)"),
    ]),
    ("P36", "spring pendulum", "standard texts", [
        ("a", "r_ddot", "r*thd^2+g*cos(th)-k/m*(r-l)"),
        ("a", "theta_ddot", "-(2*rd*thd+g*sin(th))/r"),
        ("b", "equilibrium 1@r", "l+m*g/k"),
        ("b", "omega^2", "k/m"),
        ("b", "omega^2", "g/(l+m*g/k)"),
    ]),
    ("P38", "centrifugal governor", "standard texts", [
        ("b", "omega^2", "W^2*(1-((m1+m2)*g/(m1*l*W^2))^2)/(1+2*m2/m1*(1-((m1+m2)*g/(m1*l*W^2))^2))"),
    ]),
    ("P40", "slider-crank kinematics", "engine design texts", [
        ("b", "x", "R*cos(w*t)+sqrt(L^2-R^2*sin(w*t)^2)"),
        ("b", "x_ddot", "-w^2*R*(cos(w*t)+R*cos(2*w*t)/sqrt(L^2-R^2*sin(w*t)^2)+R^3*sin(2*w*t)^2/(4*(L^2-R^2*sin(w*t)^2)^(3/2)))"),
    ]),
    ("P43", "charged particle in crossed fields", "standard texts", [
        ("a", "y_ddot", "q*B0/m*zd"),
        ("a", "z_ddot", "q*E0/m-q*B0/m*yd"),
    ]),
    ("P45", "damped pendulum", "standard texts", [
        ("a", "theta_ddot", "-k/m*thd-g/l*sin(th)"),
    ]),
    ("P47", "Chaplygin sleigh", "nonholonomic mechanics texts", [
        ("b", "theta_ddot", "-m*a*(xd*cos(th)+yd*sin(th))*thd/(I0+m*a^2)"),
        ("b", "lambda_blade", "m*I0*(xd*cos(th)+yd*sin(th))*thd/(I0+m*a^2)"),
    ]),
    ("P48", "upright rolling disc", "nonholonomic mechanics texts", [
        ("b", "theta_ddot", "0"),
        ("b", "phi_ddot", "0"),
        ("b", "lambda_rx", "-m*R*thd*phd*sin(phi)"),
        ("b", "lambda_ry", "m*R*thd*phd*cos(phi)"),
    ]),
    ("P49", "coin rolling on an incline", "nonholonomic mechanics texts", [
        ("a", "theta_ddot", "2*g*sin(al)*cos(phi)/(3*r)"),
    ]),
    ("P52", "chain sliding off a table", "standard texts", [
        ("a", "x_ddot", "g/L*x"),
        ("a", "x", "x_0*cosh(sqrt(g/L)*t)+x_dot_0*sqrt(L/g)*sinh(sqrt(g/L)*t)"),
    ]),
    ("P54", "string going slack", "standard texts", [
        ("a", "lambda_string", "-m*(g*cos(th)+l*(u^2/l^2-2*g/l*(1-cos(th))))"),
        ("b", "cos(theta)", "-(u^2-2*g*l)/(3*g*l)"),
    ]),
    ("P58", "Norton's dome", "Norton 2003", [
        ("a", "r_ddot", "sqrt(r)"),
    ]),
    ("P59", "beam on three supports", "structural mechanics texts", [
    ]),
    ("P62", "massless junction between springs", "singular Lagrangians", [
        ("a", "x_ddot", "-k1*k2*x/(m*(k1+k2))"),
    ]),
    ("P64", "hopping hoop", "Littlewood's Miscellany", [
        ("a", "theta_ddot", "m*sin(th)*(g/r+thd^2)/(2*(M+m*(1+cos(th))))"),
        ("b", "lambda_floor", "(M+m)*g-m*r*(thd^2*cos(th)+m*sin(th)*(g/r+thd^2)/(2*(M+m*(1+cos(th))))*sin(th))"),
    ]),
    ("P65", "pendulum tension", "standard texts", [
        ("b", "lambda_string", "-m*g*(3*cos(phi)-2*cos(pi/3))"),
    ]),
    ("P69", "two masses on a light rod", "standard texts", [
        ("", "lambda_rod", "-M*((x1d-x2d)^2+(y1d-y2d)^2)/(2*((x1-x2)^2+(y1-y2)^2))"),
    ]),
]

# Degrees of freedom where the source counts them.
FREEDOM = {"P01": 1, "P07": 2, "P59": 1, "P62": 1, "P69": 3, "P26": 2}
