# Root mean squared error of a trajectory, by a way of its own: nothing of pos is used but its TUM files.
#   awk -v align=none|se2|se3 -f ate.awk truth.tum estimate.tum     prints: matched xy z xyz
# Truth between two poses lies on the straight line. se3 is Horn's closed form (1987): the rotation is the eigenvector of the
# largest eigenvalue of a symmetric 4 x 4 matrix, found by Jacobi's rotations. se2 turns about the vertical only.

function seconds(stamp, dot) { # since the first stamp: whole seconds are taken apart, a double has no room for both
  dot = index(stamp, ".")
  if (whole == "") whole = substr(stamp, 1, dot - 1)
  return (substr(stamp, 1, dot - 1) - whole) + ("0" substr(stamp, dot))
}

/^#/ { next }
FNR == NR { n++; t[n] = seconds($1); tx[n] = $2; ty[n] = $3; tz[n] = $4; next }
{
  s = seconds($1)
  while (k < n && t[k + 1] <= s) k++
  if (k == 0 || (k == n && t[k] < s)) next
  w = t[k] < s ? (s - t[k]) / (t[k + 1] - t[k]) : 0
  m++
  px[m] = $2; py[m] = $3; pz[m] = $4
  qx[m] = tx[k] + (w ? w * (tx[k + 1] - tx[k]) : 0)
  qy[m] = ty[k] + (w ? w * (ty[k + 1] - ty[k]) : 0)
  qz[m] = tz[k] + (w ? w * (tz[k + 1] - tz[k]) : 0)
}

function means(i) {
  for (i = 1; i <= m; i++) {
    mpx += px[i] / m; mpy += py[i] / m; mpz += pz[i] / m
    mqx += qx[i] / m; mqy += qy[i] / m; mqz += qz[i] / m
  }
}

function correlations(i, ax, ay, az, bx, by, bz) {
  for (i = 1; i <= m; i++) {
    ax = px[i] - mpx; ay = py[i] - mpy; az = pz[i] - mpz
    bx = qx[i] - mqx; by = qy[i] - mqy; bz = qz[i] - mqz
    xx += ax * bx; xy += ax * by; xz += ax * bz
    yx += ay * bx; yy += ay * by; yz += ay * bz
    zx += az * bx; zy += az * by; zz += az * bz
  }
}

function jacobi(i, j, l, sweep, theta, tangent, c, s, a, b) { # of A; the eigenvectors become the columns of V
  for (i = 0; i < 4; i++) for (j = 0; j < 4; j++) V[i, j] = i == j
  for (sweep = 0; sweep < 30; sweep++)
    for (i = 0; i < 3; i++)
      for (j = i + 1; j < 4; j++) {
        if (A[i, j] == 0) continue
        theta = (A[j, j] - A[i, i]) / (2 * A[i, j])
        tangent = (theta < 0 ? -1 : 1) / ((theta < 0 ? -theta : theta) + sqrt(theta * theta + 1))
        c = 1 / sqrt(tangent * tangent + 1); s = tangent * c
        for (l = 0; l < 4; l++) { a = A[l, i]; b = A[l, j]; A[l, i] = c * a - s * b; A[l, j] = s * a + c * b }
        for (l = 0; l < 4; l++) { a = A[i, l]; b = A[j, l]; A[i, l] = c * a - s * b; A[j, l] = s * a + c * b }
        for (l = 0; l < 4; l++) { a = V[l, i]; b = V[l, j]; V[l, i] = c * a - s * b; V[l, j] = s * a + c * b }
      }
}

function horn(i, j) { # the quaternion w x y z that turns the estimate onto the truth
  A[0, 0] = xx + yy + zz; A[0, 1] = yz - zy; A[0, 2] = zx - xz; A[0, 3] = xy - yx
  A[1, 1] = xx - yy - zz; A[1, 2] = xy + yx; A[1, 3] = zx + xz
  A[2, 2] = -xx + yy - zz; A[2, 3] = yz + zy; A[3, 3] = -xx - yy + zz
  for (i = 0; i < 4; i++) for (j = 0; j < i; j++) A[i, j] = A[j, i]
  jacobi()
  j = 0
  for (i = 1; i < 4; i++) if (A[i, i] > A[j, j]) j = i
  w = V[0, j]; x = V[1, j]; y = V[2, j]; z = V[3, j]
}

function apply(i, ax, ay, az) { # rotation w x y z about the means
  for (i = 1; i <= m; i++) {
    ax = px[i] - mpx; ay = py[i] - mpy; az = pz[i] - mpz
    px[i] = mqx + (1 - 2 * (y * y + z * z)) * ax + 2 * (x * y - w * z) * ay + 2 * (x * z + w * y) * az
    py[i] = mqy + 2 * (x * y + w * z) * ax + (1 - 2 * (x * x + z * z)) * ay + 2 * (y * z - w * x) * az
    pz[i] = (align == "se3" ? mqz : mpz) + 2 * (x * z - w * y) * ax + 2 * (y * z + w * x) * ay + (1 - 2 * (x * x + y * y)) * az
  }
}

END {
  if (align != "none") {
    means(); correlations()
    if (align == "se3") {
      horn()
    } else {
      angle = atan2(xy - yx, xx + yy)
      w = cos(angle / 2); x = 0; y = 0; z = sin(angle / 2)
    }
    apply()
  }
  for (i = 1; i <= m; i++) {
    flat += (px[i] - qx[i]) ^ 2 + (py[i] - qy[i]) ^ 2
    high += (pz[i] - qz[i]) ^ 2
  }
  printf "%d %.15g %.15g %.15g\n", m, sqrt(flat / m), sqrt(high / m), sqrt((flat + high) / m)
}
