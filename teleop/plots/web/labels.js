// Words on a canvas that never lie over each other: each is put where there is room, or left out.
//
// What was put is kept, in pixels of the page, so that a test can see that nothing overlaps.

const placed = {}; // by plot: [left, top, right, bottom] of each word, and the word

class Words {
  constructor(name, ctx, area, pixel) {
    Object.assign(this, { ctx, area, pixel, taken: [] });
    this.kept = placed[name] = [];
  }
  // Something drawn that no word may cover.
  keepOut(x, y, half) {
    this.taken.push([x - half, y - half, x + half, y + half]);
  }
  // The word at the first of the spots [x, middle] that is free; `align` is the side of the word that is at x.
  put(text, color, spots) {
    const width = this.ctx.measureText(text).width, high = 12 * this.pixel, gap = 2 * this.pixel;
    for (const [x, middle, align] of spots) {
      const left = align === "center" ? x - width / 2 : align === "right" ? x - width : x;
      const box = [left - gap, middle - high / 2, left + width + gap, middle + high / 2];
      if (box[0] < this.area.left || box[2] > this.area.left + this.area.width) continue;
      if (box[1] < this.area.top || box[3] > this.area.top + this.area.height) continue;
      if (this.taken.some((other) => box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3])) continue;
      this.taken.push(box);
      this.kept.push({ text, box: box.map((each) => each / this.pixel) });
      this.write(text, color, left, middle);
      return true;
    }
    return false;
  }
  write(text, color, left, middle) {
    const { ctx } = this;
    Object.assign(ctx, { textAlign: "left", textBaseline: "middle", lineJoin: "round", lineWidth: 3 * this.pixel, strokeStyle: "#171a1f" });
    ctx.strokeText(text, left, middle); // a curve behind the word stops short of it
    ctx.fillStyle = color;
    ctx.fillText(text, left, middle);
    ctx.lineWidth = this.pixel;
  }
}
