// An MCAP file of a run beside the run's tables.
//   node check.mjs FILE.mcap RUN_FOLDER
import { readFile } from 'node:fs/promises';
import { fail, nanoseconds, wholeFile } from './whole_file.mjs';

const [file, folder] = process.argv.slice(2);
const { topics, attachments } = await wholeFile(file);
if (!attachments.includes('run.json')) fail('run.json is not attached');

/** Rows of <name>.tum and <name>.csv beside the messages. */
async function compare(name, prefix) {
  const rows = (await readFile(`${folder}/${name}.tum`, 'utf8')).split('\n').filter((line) => line && !line.startsWith('#'));
  const [head, ...cells] = (await readFile(`${folder}/${name}.csv`, 'utf8')).trim().split('\n').map((line) => line.split(','));
  const poses = topics.get(`${prefix}/pose`) ?? [];
  const odometry = topics.get(`${prefix}/odometry`) ?? [];
  if (poses.length !== rows.length || odometry.length !== rows.length) return fail(`${name}: ${rows.length} rows, ${poses.length} poses, ${odometry.length} odometries`);
  let worst = 0;
  rows.forEach((row, index) => {
    const [stamp, ...numbers] = row.split(' ');
    const { position: p, orientation: q } = poses[index].value.pose;
    if (nanoseconds(stamp) !== poses[index].stamp) fail(`${name}: stamp of row ${index}`);
    [p.x, p.y, p.z, q.x, q.y, q.z, q.w].forEach((value, at) => (worst = Math.max(worst, Math.abs(value - Number(numbers[at])))));
    const sigma = Number(cells[index][head.indexOf('sigma_x_m')]);
    worst = Math.max(worst, Math.abs(odometry[index].value.pose.covariance[0] - sigma * sigma));
  });
  console.log(`${name}: ${rows.length} poses, largest difference ${worst.toExponential(1)}`);
  if (!(worst < 1e-9)) fail(`${name}: values differ`);
}
const names = [...topics.keys()].filter((topic) => topic.endsWith('/odometry')).map((topic) => topic.slice(1, -'/odometry'.length));
const only = process.env.ESTIMATOR;
for (const name of names) await compare(name === 'estimate' ? only : name, `/${name}`);
if (names.length === 0) fail('no estimator in the file');
const markers = topics.get('/map/markers')?.[0]?.value.markers ?? [];
if (markers.length === 0) fail('no markers of the map');
