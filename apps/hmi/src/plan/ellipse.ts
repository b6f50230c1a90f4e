/** The ellipse of a planar covariance. */

export interface Ellipse {
  /** Half axes, m, longer first. */
  major: number;
  minor: number;
  /** Direction of the longer one, rad from east, counter-clockwise. */
  angle: number;
}

/** Contains the true place with a probability of 95 % for the default `factor` = sqrt(5.991), the chi-square quantile of two axes. */
export function ellipseOf(pxx: number, pxy: number, pyy: number, factor = Math.sqrt(5.991)): Ellipse {
  const mean = (pxx + pyy) / 2;
  const spread = Math.hypot((pxx - pyy) / 2, pxy);
  return {
    major: factor * Math.sqrt(Math.max(0, mean + spread)),
    minor: factor * Math.sqrt(Math.max(0, mean - spread)),
    angle: 0.5 * Math.atan2(2 * pxy, pxx - pyy),
  };
}
