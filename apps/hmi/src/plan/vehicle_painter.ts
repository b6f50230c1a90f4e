/** Draws where an estimator says the vehicle is: covariance ellipse, body, direction, name. */

import type { EstimatorNow, Pose } from '../protocol/messages';
import type { Window } from './track_painter';

const kTwoAxes95 = Math.sqrt(5.991); // chi-square quantile, 95 %, 2 degrees of freedom

export interface VehicleStyle {
  colour: string;
  edge: string;
  main: boolean;
}

export function paintVehicle(context: CanvasRenderingContext2D, window: Window, now: EstimatorNow, style: VehicleStyle): void {
  if (!now.pose) return;
  const { x, y } = pixel(window, now.pose);
  context.save();
  context.translate(x, y);
  if (now.ellipse) paintEllipse(context, window, now.ellipse, style.colour);
  paintBody(context, now.pose.yaw_rad, style);
  context.restore();
}

export function paintTruth(context: CanvasRenderingContext2D, window: Window, pose: Pose, colour: string): void {
  const { x, y } = pixel(window, pose);
  context.save();
  context.strokeStyle = colour;
  context.lineWidth = 2;
  context.beginPath();
  for (const [dx, dy] of [[1, 0], [0, 1], [-1, 0], [0, -1]] as const) {
    context.moveTo(x + 4 * dx, y + 4 * dy);
    context.lineTo(x + 13 * dx, y + 13 * dy);
  }
  context.stroke();
  context.restore();
}

function pixel(window: Window, pose: Pose): { x: number; y: number } {
  return { x: (pose.x_m - window.left) / window.resolution, y: (window.top - pose.y_m) / window.resolution };
}

function paintEllipse(
  context: CanvasRenderingContext2D,
  window: Window,
  ellipse: NonNullable<EstimatorNow['ellipse']>,
  colour: string,
): void {
  const [major, minor] = [ellipse.major_m, ellipse.minor_m].map((axis) => Math.max(1, (kTwoAxes95 * axis) / window.resolution));
  context.beginPath();
  context.ellipse(0, 0, major!, minor!, -ellipse.angle_rad, 0, 2 * Math.PI);
  context.globalAlpha = 0.15;
  context.fillStyle = colour;
  context.fill();
  context.globalAlpha = 1;
  context.strokeStyle = colour;
  context.lineWidth = 1.5;
  context.setLineDash([4, 3]);
  context.stroke();
  context.setLineDash([]);
}

/** A sign, not to scale: a box with a pointed nose; a circle where the heading is not known. */
function paintBody(context: CanvasRenderingContext2D, yaw: number | null, style: VehicleStyle): void {
  const length = style.main ? 12 : 9;
  const width = style.main ? 6 : 4.5;
  context.fillStyle = style.colour;
  context.strokeStyle = style.edge;
  context.lineWidth = 1.5;
  context.beginPath();
  if (yaw === null) {
    context.arc(0, 0, width, 0, 2 * Math.PI);
  } else {
    context.rotate(-yaw);
    context.moveTo(length, 0);
    context.lineTo(0.35 * length, width);
    context.lineTo(-length, width);
    context.lineTo(-length, -width);
    context.lineTo(0.35 * length, -width);
    context.closePath();
  }
  context.fill();
  context.stroke();
}
