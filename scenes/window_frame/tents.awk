# SPDX-License-Identifier: Apache-2.0
# Puts a low tent on each triangle of an OBJ: where faces are flat shaded, all of them can be seen.
$1 == "v" { x[++n] = $2; y[n] = $3; z[n] = $4; print }
$1 == "f" {
    a = $2 + 0; b = $3 + 0; c = $4 + 0
    ux = x[b] - x[a]; uy = y[b] - y[a]; uz = z[b] - z[a]
    vx = x[c] - x[a]; vy = y[c] - y[a]; vz = z[c] - z[a]
    nx = uy * vz - uz * vy; ny = uz * vx - ux * vz; nz = ux * vy - uy * vx
    size = sqrt(sqrt(nx * nx + ny * ny + nz * nz))
    rise = size > 0 ? 0.12 / size : 0
    printf "v %.6f %.6f %.6f\n", (x[a] + x[b] + x[c]) / 3 + rise * nx, \
        (y[a] + y[b] + y[c]) / 3 + rise * ny, (z[a] + z[b] + z[c]) / 3 + rise * nz
    tents[++m] = a " " b " " c
}
END {
    for (i = 1; i <= m; ++i) {
        split(tents[i], corner, " ")
        print "f", corner[1], corner[2], n + i
        print "f", corner[2], corner[3], n + i
        print "f", corner[3], corner[1], n + i
    }
}
