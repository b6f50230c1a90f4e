/** One uPlot chart with a line at the present moment; a click goes to that moment. */

import uPlot from 'uplot';
import type { Line } from '../model/context';
import type { Paint } from '../ui/theme';

export interface Series {
  name: string;
  line: Line;
  values: (number | null | undefined)[];
}

export interface Level {
  value: number;
  label: string;
  dash: number[];
}

export interface ChartData {
  x: number[];
  series: Series[];
  /** Horizontal lines with a name: limits, chambers. */
  levels: Level[];
}

export interface ChartWishes {
  axisX: string;
  axisY: string;
  startsAtZero: boolean;
  onMoment: (x: number) => void;
  /** A stretch of time was chosen; null: all of it. */
  onRange: (range: [number, number] | null) => void;
}

export class Chart {
  private plot: uPlot | null = null;
  private key = '';
  private now: number | null = null;
  private levels: Level[] = [];

  constructor(
    private readonly host: HTMLElement,
    private readonly paint: Paint,
    private readonly wishes: ChartWishes,
  ) {
    new ResizeObserver(() => this.fitHost()).observe(host);
  }

  show(data: ChartData): void {
    const key = data.series.map((series) => series.name).join();
    this.levels = data.levels;
    const values = [data.x, ...data.series.map((series) => series.values)] as uPlot.AlignedData;
    if (this.plot && key === this.key) {
      this.plot.setData(values, true);
      return;
    }
    this.plot?.destroy();
    this.key = key;
    this.plot = new uPlot(this.settings(data.series), values, this.host);
  }

  showNow(x: number | null): void {
    if (x === this.now) return;
    this.now = x;
    this.plot?.redraw(false, false);
  }

  clear(): void {
    this.plot?.destroy();
    this.plot = null;
    this.key = '';
  }

  private fitHost(): void {
    if (this.host.clientWidth > 0) this.plot?.setSize(this.size());
  }

  private size(): { width: number; height: number } {
    return { width: Math.max(200, this.host.clientWidth), height: Math.max(110, this.host.clientHeight - 30) };
  }

  private settings(series: Series[]): uPlot.Options {
    const axis = { stroke: this.paint.text, grid: { stroke: this.paint.roadEdge, width: 0.5 }, ticks: { show: false } };
    return {
      ...this.size(),
      legend: { live: true },
      cursor: { drag: { x: true, y: false, setScale: false } },
      scales: { x: { time: false }, y: this.wishes.startsAtZero ? { range: (_, __, max) => [0, max > 0 ? 1.08 * max : 1] } : {} },
      axes: [
        { ...axis, label: this.wishes.axisX, labelSize: 16, size: 26, labelFont: '11px system-ui' },
        { ...axis, label: this.wishes.axisY, labelSize: 16, size: 48, labelFont: '11px system-ui' },
      ],
      series: [
        { label: this.wishes.axisX, value: (_, value) => (value === null || value === undefined ? '–' : value.toFixed(1)) },
        ...series.map((one) => ({
          label: one.name,
          stroke: one.line.colour,
          dash: one.line.dash,
          width: 1.5,
          points: { show: false },
          value: (_: uPlot, value: number | null) => (value === null || value === undefined ? '–' : value.toFixed(3)),
        })),
      ],
      hooks: {
        draw: [(plot) => this.drawMarks(plot)],
        ready: [(plot) => this.listen(plot)],
        setSelect: [(plot) => this.choose(plot)],
      },
    };
  }

  private choose(plot: uPlot): void {
    if (plot.select.width < 8) return;
    const { left, width } = plot.select;
    this.wishes.onRange([plot.posToVal(left, 'x'), plot.posToVal(left + width, 'x')]);
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
  }

  private listen(plot: uPlot): void {
    plot.over.addEventListener('dblclick', () => this.wishes.onRange(null));
    let pressedAt = 0;
    plot.over.addEventListener('mousedown', (press) => (pressedAt = press.clientX));
    plot.over.addEventListener('click', (click) => {
      if (Math.abs(click.clientX - pressedAt) > 4) return;
      this.wishes.onMoment(plot.posToVal(click.clientX - plot.over.getBoundingClientRect().left, 'x'));
    });
  }

  private drawMarks(plot: uPlot): void {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.font = `${11 * devicePixelRatio}px system-ui`;
    ctx.textAlign = 'left';
    ctx.setLineDash([]);
    let named = Infinity; // names stand at least a line apart
    for (const level of this.levels) {
      const y = plot.valToPos(level.value, 'y', true);
      const free = Math.abs(named - y) >= 13 * devicePixelRatio;
      if (free) named = y;
      this.drawLevel(plot, y, { ...level, label: free ? level.label : '' });
    }
    if (this.now !== null) {
      const x = plot.valToPos(this.now, 'x', true);
      ctx.strokeStyle = this.paint.accent;
      ctx.lineWidth = 2;
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
    }
    ctx.restore();
  }

  private drawLevel(plot: uPlot, y: number, level: Level): void {
    const { ctx, bbox } = plot;
    ctx.strokeStyle = this.paint.faint;
    ctx.fillStyle = this.paint.faint;
    ctx.lineWidth = 1;
    ctx.setLineDash(level.dash);
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
    ctx.setLineDash([]);
    ctx.fillText(level.label, bbox.left + 4, y - 3);
  }
}
