// An MCAP file of a log beside the same log as JSON lines.
//   node check_log.mjs FILE.mcap FILE.jsonl
import { readFile } from 'node:fs/promises';
import { fail, wholeFile } from './whole_file.mjs';

const [file, lines] = process.argv.slice(2);
const { topics } = await wholeFile(file);
const readings = (await readFile(lines, 'utf8')).trim().split('\n').map((line) => JSON.parse(line));

/** Numbers of a reading as the log tells them, and of its message. */
const pairs = {
  imu: (r, m) => [
    ...['x', 'y', 'z'].map((axis, i) => [r.rates_deg_per_s[i], (m.angular_velocity[axis] * 180) / Math.PI]),
    ...['x', 'y', 'z'].map((axis, i) => [r.force_m_per_s2[i], m.linear_acceleration[axis]]),
  ],
  range: (r, m) => [
    [r.range_m, m.range],
    [r.anchor, m.anchor],
    [r.tag ?? 0, m.tag],
  ],
  gnss: (r, m) => [
    [r.latitude_deg, m.latitude],
    [r.longitude_deg, m.longitude],
    [r.altitude_m, m.altitude],
  ],
  truth: (r, m) => ['x', 'y', 'z'].map((axis, i) => [r.position_m[i], m.pose.position[axis]]),
};

const at = new Map();
let worst = 0;
let compared = 0;
for (const reading of readings) {
  const topic = reading.reading === 'truth' ? '/ground_truth/pose' : `/${reading.sensor}`;
  const index = at.get(topic) ?? 0;
  at.set(topic, index + 1);
  const message = topics.get(topic)?.[index];
  if (!message) fail(`no message ${index} on ${topic}`);
  if (!message || !pairs[reading.reading]) continue;
  for (const [told, found] of pairs[reading.reading](reading, message.value)) {
    if (typeof told !== 'number') {
      fail(`a ${reading.reading} without the number that is compared: ${JSON.stringify(reading)}`);
      break;
    }
    worst = Math.max(worst, Math.abs(told - found));
    ++compared;
  }
}
console.log(`${readings.length} readings, ${compared} numbers compared, largest difference ${worst.toExponential(1)}`);
if (!(worst < 1e-9) || compared === 0) fail('values differ');
