// The demodulator in full numbers, as Markdown: frames lost against energy a bit, beside theory, and frames heard in an
// hour of noise. With a path as argument the curve is drawn there (docs/frame_error_rate.png).

#include <cstdio>

#include "lodestar/evaluation/curve_plot.hpp"
#include "support/frame_trials.hpp"

int main(int argc, char** argv) {
  using namespace lodestar;
  constexpr int kTrials = 4000;
  CurvePlot plot{"Frames lost, 8 diodes, light of a hall, both clocks off by up to 100 ppm",
                 "Eb / N0, dB",
                 "share of frames lost",
                 {{"coherent Manchester, hard decisions, RS(46,36): theory", {}}, {"measured", {}}}};
  std::printf(
      "| Eb / N0 dB | lost, theory | lost, measured | theory needs dB | beyond theory dB | stamp rms us | false |\n"
      "|---|---|---|---|---|---|---|\n");
  for (double db = 3.0; db < 6.6; db += 0.5) {
    const test::FrameTrials trials = test::frame_trials(db, kTrials);
    const double lost = static_cast<double>(trials.lost) / trials.sent, ideal = test::ideal_frame_error_rate(db);
    const double same_db = test::ideal_eb_n0_db(lost);
    std::printf("| %.1f | %.4f | %.4f | %.2f | %.2f | %.2f | %d |\n", db, ideal, lost, same_db, db - same_db,
                1e6 * std::sqrt(trials.stamp_error2_s2 / std::max(1, trials.sent - trials.lost)), trials.false_frames);
    std::fflush(stdout);
    plot.lines[0].points.emplace_back(db, ideal);
    plot.lines[1].points.emplace_back(db, lost);
  }
  if (argc > 1) plot_curves(argv[1], plot);
}
