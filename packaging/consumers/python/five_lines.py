import contact_normal, numpy as np
dx, dy, _, force, G, nu = map(float, open("y4_82kN.txt").readlines()[3].split()[2:])
h = np.loadtxt("y4_82kN.txt", skiprows=4)[:, 0].reshape(88, 95)
result = contact_normal.solve(h, dx, dy, force=force, shear_modulus=G, poisson_ratio=nu)
result.plot().figure.savefig("wheel_rail.png")
