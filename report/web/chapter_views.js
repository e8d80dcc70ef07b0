import { HistoryView, Run, make_fixed_chart } from "./history.js";
import { BodeView, ScatterView, make_poles_chart } from "./linear_view.js";
import { ModesView } from "./modes_view.js";
import { MotionView } from "./motion_view.js";
import { SpinView } from "./spin_view.js";

// Interactive view of each static picture: data-view of its element -> an object with `element`.
export const kViews = {
  history: (chapter) => new HistoryView(chapter.run),
  motion: (chapter) => new MotionView(chapter.run),
  energy: (chapter) => make_fixed_chart(chapter.run, "Energy", ["kinetic", "strain", "potential", "work", "dissipated"].map((p) => "/energy/" + p)),
  balance: (chapter) => make_fixed_chart(chapter.run, "Error of the energy balance", ["/energy/balance"]),
  "momentum-linear": (chapter) => make_fixed_chart(chapter.run, "Linear momentum", ["/momentum/linear"]),
  "momentum-angular": (chapter) => make_fixed_chart(chapter.run, "Angular momentum", ["/momentum/angular"]),
  modes: (chapter) => new ModesView(chapter.data),
  poles: (chapter) => make_poles_chart(chapter.data),
  bode: (chapter) => new BodeView(chapter.data),
  spin: (chapter) => new SpinView(chapter.data),
  scatter: (chapter) => new ScatterView(chapter.data),
};

// Data of a chapter, from its JSON text.
export class ReportChapter {
  constructor(text) {
    this.data = JSON.parse(text);
    this.kept = null;
  }
  get run() {
    this.kept ??= new Run(this.data);
    return this.kept;
  }
}
