// What the detector reaches and where it ends: detection probability, false alarms, centres, motion, lamps. Prints
// Markdown for docs/reports; run by hand. The tests in test/consistency/sensing/beacon run smaller numbers of the same.
//
// Usage: report_detector [--scale S] [probability alarms centre range motion follow lamps]

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string>

#include "lodestar/base/common/chi_square.hpp"
#include "support/beacon/centre_trials.hpp"
#include "support/beacon/detection_probability.hpp"
#include "support/beacon/false_alarms.hpp"
#include "support/beacon/hall_of_lamps.hpp"
#include "support/beacon/motion_trials.hpp"

namespace lodestar {
namespace {

double scale = 1;  ///< of the numbers of trials

int scaled(int count) { return std::max(1, static_cast<int>(count * scale)); }
const char* yes(bool value) { return value ? "yes" : "no"; }

/// Where a measured curve passes a probability, by straight lines between its points, beside theory; else on which side
/// of all points that is.
std::string crossing(const std::vector<std::pair<double, double>>& curve, double probability, double theory_db) {
  char text[32];
  const auto say = [&](const char* format, double at_db) {
    std::snprintf(text, sizeof(text), format, at_db - theory_db);
    return std::string(text);
  };
  if (curve.front().second >= probability) return say("below %+.2f dB", curve.front().first);
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const auto [x0, p0] = curve[i - 1];
    const auto [x1, p1] = curve[i];
    if (p0 < probability && p1 >= probability) return say("%+.2f dB", x0 + (x1 - x0) * (probability - p0) / (p1 - p0));
  }
  return say("above %+.2f dB", curve.back().first);
}

void report_probability() {
  std::printf(
      "\n## Detection probability\n\nVGA, 25 frames/s, one tone of two (5 and 10 Hz), noise 2 grey levels and "
      "rounding, "
      "PSF sigma 0.9 px, sub-pixel and tone phase at random. SNR: N a^2 / (4 s2) in the brightest pixel, after the "
      "window. Theory: one pixel, one tone, noncentral chi-square with 2 degrees of freedom, threshold %.1f for one "
      "false alarm an hour. Offset: measured less theory, negative is better.\n\n",
      test::DetectionTrials().threshold());
  std::printf(
      "| N | Pd, measured / theory, at theory's SNR for 0.5 less 2, 1, 0, plus 1, 2, 3, 4 dB | offset at 0.5 | offset "
      "at 0.99 |\n|---|---|---|---|\n");
  for (const int window : {5, 10, 15, 30, 60}) {
    test::DetectionTrials trials;
    trials.window_frames = window;
    const double half_db = trials.theory_snr_db(0.5);
    std::vector<std::pair<double, double>> curve;
    std::string cells;
    for (double offset_db = -2; offset_db <= 4.01; offset_db += 0.5) {
      const double measured = trials.measure(half_db + offset_db, scaled(3000), static_cast<unsigned>(window));
      curve.push_back({half_db + offset_db, measured});
      char cell[64];
      std::snprintf(cell, sizeof(cell), " %.3f/%.3f", measured, trials.theory(half_db + offset_db));
      if (std::abs(offset_db - std::round(offset_db)) < 0.1) cells += cell;
    }
    std::printf("| %d |%s | %s | %s |\n", window, cells.c_str(), crossing(curve, 0.5, half_db).c_str(),
                crossing(curve, 0.99, trials.theory_snr_db(0.99)).c_str());
    std::fflush(stdout);
  }
}

void report_alarms() {
  std::printf(
      "\n## False alarms\n\nVGA at 25 frames/s, no light. The stated rate is raised by a factor until it can be "
      "counted; noise has exponential tails in power, P(> x) = exp(-x / 2), so each factor of ten moves the threshold "
      "by "
      "4.6, and a ratio that does not grow from line to line carries over to the default. Events: sightings that do "
      "not "
      "continue one of the N frames before.\n\n");
  std::printf(
      "| N | ceiling | factor | hours | stated | sightings | events | sightings / stated "
      "|\n|---|---|---|---|---|---|---|---|\n");
  const auto line = [](int window, bool uneven, double factor, int frames) {
    test::FalseAlarms alarms;
    alarms.window_frames = window;
    alarms.uneven = uneven;
    alarms.factor = factor;
    alarms.run(frames, 1);
    std::printf("| %d | %s | %.0e | %.2f | %.1f | %ld | %ld | %.2f |\n", window, uneven ? "uneven" : "even", factor,
                alarms.hours(), alarms.stated(), alarms.sightings, alarms.events,
                static_cast<double>(alarms.sightings) / alarms.stated());
    std::fflush(stdout);
  };
  for (const int window : {5, 15, 30, 60}) {
    for (const double factor : {1e6, 1e5, 1e4}) line(window, false, factor, scaled(factor > 2e4 ? 5000 : 20000));
  }
  for (const double factor : {1e6, 1e5, 1e4}) line(15, true, factor, scaled(factor > 2e4 ? 5000 : 20000));
  line(15, false, 1e3, scaled(90000));
  line(15, true, 1e3, scaled(90000));
  // As shipped, long enough to need no extrapolation: none in H hours is below 3 / H an hour with 95 %.
  constexpr int kHour_frames = static_cast<int>(3600 * test::FalseAlarms::kRate_hz);
  for (const int window : {5, 30, 60}) line(window, false, 1, scaled(3 * kHour_frames));
  line(15, false, 1, scaled(10 * kHour_frames));
  line(15, true, 1, scaled(5 * kHour_frames));
}

void report_centre() {
  std::printf(
      "\n## Centre\n\nVGA, 12 bits in 16, 60 frames/s, N = 30, read noise 3 e, background 6 e, gain such that nothing "
      "clips. Electrons: of the beacon, in one frame on average. CRB: Cramer-Rao bound with an unknown constant behind "
      "each pixel; in brackets the ratio to the bound where a flat background is known. NEES: normalised error squared "
      "of the reported covariance, mean over both axes, with its 99 %% band.\n\n");
  std::printf(
      "| tones | PSF sigma | electrons | seen | rms px | rms / CRB | NEES | band "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (const int tones : {1, 2}) {
    for (const double sigma_px : {0.5, 0.7, 1.0, 1.5}) {
      for (const double electrons : {300., 1000., 3000., 10000., 30000., 100000.}) {
        test::CentreTrials trials;
        trials.tones = tones;
        trials.psf_sigma_px = sigma_px;
        trials.electrons = electrons;
        trials.run(scaled(700), 1);
        const double dof = 2 * std::max(1, trials.seen);
        std::printf("| %d | %.1f | %.0f | %.3f | %.5f | %.2f (%.2f) | %.2f | %.2f .. %.2f |\n", tones, sigma_px,
                    electrons, static_cast<double>(trials.seen) / trials.trials, trials.rms_px(),
                    trials.rms_px() / trials.crb_px(), trials.rms_px() / trials.crb_known_background_px(),
                    trials.mean_nees(), chi_square_quantile(0.005, dof) / dof, chi_square_quantile(0.995, dof) / dof);
        std::fflush(stdout);
      }
    }
  }
  std::printf("\nBias over the sub-pixel phase (u = v), 100 000 electrons, px:\n\n| PSF sigma |");
  for (int step = -5; step <= 5; ++step) std::printf(" %.1f |", 0.1 * step);
  std::printf("\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const double sigma_px : {0.5, 0.7, 1.0, 1.5}) {
    std::printf("| %.1f |", sigma_px);
    for (int step = -5; step <= 5; ++step) {
      test::CentreTrials trials;
      trials.psf_sigma_px = sigma_px;
      trials.electrons = 100000;
      const Eigen::Vector2d phase = Eigen::Vector2d::Constant(0.1 * step);
      trials.run(scaled(210), 2, &phase);
      std::printf(" %.4f |", trials.bias_px());
    }
    std::printf("\n");
  }
  std::printf(
      "\nSaturated: the brightest pixel at its brightest, times white.\n\n| bits | PSF sigma | times | seen | rms px, "
      "each axis | worst px |\n|---|---|---|---|---|---|\n");
  for (const int bits : {8, 16}) {
    for (const double sigma_px : {0.7, 1.0, 1.5}) {
      for (const double times : {2., 5., 10., 20.}) {
        test::SaturatedTrials trials;
        for (int run = 0; run < scaled(4); ++run) trials.run(times, bits, sigma_px, static_cast<unsigned>(run));
        std::printf("| %d | %.1f | %.0f | %.3f | %.4f | %.3f |\n", bits == 8 ? 8 : 12, sigma_px, times,
                    static_cast<double>(trials.seen) / trials.trials, trials.rms_px(), trials.worst_px);
        std::fflush(stdout);
      }
    }
  }
}

void report_range() {
  std::printf(
      "\n## Twelve bits: 3 m overhead and 25 m at 70 deg in one image\n\nThe far one is 594 times dimmer (distances "
      "squared, Lambert's cosine, the lens's cosine). Exposure: the near one's brightest pixel at its brightest, times "
      "white. 20 images each.\n\n| exposure | far one's peak, levels | near seen | far seen | near rms px | far rms px "
      "|\n|---|---|---|---|---|---|\n");
  for (const double exposure : {0.9, 2., 4., 7., 10.}) {
    int near = 0, far = 0;
    double near_square = 0, far_square = 0, peak = 0;
    constexpr int kImages = 20;
    for (unsigned seed = 0; seed < kImages; ++seed) {
      test::NearAndFar image;
      image.run(exposure, seed);
      near += image.near_seen;
      far += image.far_seen;
      near_square += image.near_seen ? image.near_error_px * image.near_error_px : 0;
      far_square += image.far_seen ? image.far_error_px * image.far_error_px : 0;
      peak = image.far_peak_levels;
    }
    std::printf("| %.1f | %.1f | %d/%d | %d/%d | %.3f | %.3f |\n", exposure, peak, near, kImages, far, kImages,
                std::sqrt(near_square / (2 * near)), std::sqrt(far_square / (2 * far)));
  }
}

void motion_line(const char* what, const test::MotionCase& motion, int windows) {
  const test::MotionTally tally = test::motion_windows(motion, windows, 1);
  std::printf("| %s | %s | %s | %ld | %.2f %% | %ld | %ld | %.3f |\n", what, motion.motion_input ? "yes" : "no",
              motion.square ? "square" : "sine, two tones", tally.windows, 100 * tally.identified(), tally.wrong,
              tally.ghosts, tally.rms_px());
  std::fflush(stdout);
}

void report_motion() {
  std::printf(
      "\n## Motion\n\nVGA, 8 bits, 60 frames/s, N = 30, exposure 2 ms, beacons of 100 to 1000 grey levels in all, shot "
      "noise of 20 e a level. A window: one frame and one beacon that has been in view for N + 5 frames. Linear: lens "
      "without distortion, heights within 5 %% of what the detector is told. Motion input: gyro and wheels, 1 %% scale "
      "error. Right: the beacon's own code within 5 px. Ghost: a sighting further from any beacon. rms: each axis, at "
      "the "
      "newest frame.\n\n| case | motion input | code | windows | right | wrong code | ghosts | rms px "
      "|\n|---|---|---|---|---|---|---|---|\n");
  using Path = test::MotionCase::Path;
  for (const bool square : {false, true}) {
    for (const bool input : {true, false}) {
      test::MotionCase motion;
      motion.square = square;
      motion.motion_input = input;
      for (const double speed : {0., 1., 2., 3., 4., 6., 8., 12., 16.}) {
        motion.speed = speed;
        motion_line((std::to_string(static_cast<int>(speed)) + " px a frame").c_str(), motion, scaled(10000));
      }
      motion.path = Path::kYaw;
      motion.speed = radians(90);
      motion_line("yaw 90 deg/s, 70 deg off axis", motion, scaled(10000));
      if (input) continue;
      motion.path = Path::kHandHeld;
      for (const double speed : {1., 3., 6.}) {
        motion.speed = speed;
        motion_line(("hand-held, up to " + std::to_string(static_cast<int>(speed)) + " px a frame").c_str(), motion,
                    scaled(10000));
      }
    }
  }
  test::MotionCase motion;
  motion.speed = 3;
  motion.jitter = 0.2;
  motion_line("3 px, jitter 20 %", motion, scaled(10000));
  motion.jitter = 0;
  motion.loss = 0.1;
  motion_line("3 px, 10 % lost", motion, scaled(10000));
  motion.loss = 0;
  motion.lost_in_a_row = 4;
  motion_line("3 px, 4 lost in a row", motion, scaled(10000));
  motion.lost_in_a_row = 0;
  for (const double offset_s : {0.01, 0.03, -0.03}) {
    motion.stamp_offset_s = offset_s;
    motion_line(("3 px, stamps off by " + std::to_string(static_cast<int>(1000 * offset_s)) + " ms").c_str(), motion,
                scaled(10000));
  }
  motion.stamp_offset_s = 0;
  motion.speed = 0;
  motion.jitter = 0.2;
  motion.loss = 0.1;
  motion_line("standing, jitter 20 %, 10 % lost", motion, scaled(10000));
  motion.square = true;
  motion_line("standing, jitter 20 %, 10 % lost", motion, scaled(10000));
  motion.speed = 3;
  motion_line("3 px, jitter 20 %, 10 % lost", motion, scaled(10000));
  motion.loss = 0;
  motion_line("3 px, jitter 20 %", motion, scaled(10000));
}

void report_follow() {
  std::printf(
      "\n## On, hidden, back\n\nN = 30, 60 frames/s, worst of %d runs, frames; hidden at random instants for 5 to 60 "
      "frames. Limits: first N + 5 = 35, ghosts 3, back N/2 + 5 = 20; of on-off codes ghosts 5 at 6 Hz and 4 at 8 Hz, "
      "their dark halves. Gaps: frames in view without a sighting, of all runs; early: while the window still holds "
      "the dark of before.\n\n| code, Hz | px a frame | motion "
      "input | light, levels | first seen after | last ghost | back after | gaps, early | wrong |\n"
      "|---|---|---|---|---|---|---|---|---|\n",
      scaled(60));
  const std::vector<std::pair<ToneSet, bool>> codes = {
      {{1, 4}, false}, {{0, 2}, false}, {{5, 7}, false}, {{1, 4, 6}, false}, {{0}, false}, {{1}, false},
      {{3}, false},    {{7}, false},    {{0}, true},     {{1}, true},        {{3}, true},  {{7}, true}};
  for (const auto& [code, square] : codes) {
    for (const auto& [speed, input] : {std::pair(0., true), std::pair(2., true), std::pair(2., false)}) {
      for (const double light : {100., 400.}) {
        int first = 0, back = 0, ghost = 0, gaps = 0, early = 0, wrong = 0, never = 0;
        for (int run = 0; run < scaled(60); ++run) {
          test::DarkAndHidden trial;
          trial.own = trial.back = code;
          trial.square = square;
          trial.speed_px = speed;
          trial.motion_input = input;
          trial.hidden_frames = 5 + run % 56;
          trial.light = light;
          trial.run(static_cast<unsigned>(run));
          never += !trial.frames_until_seen || !trial.frames_until_back;
          first = std::max(first, trial.frames_until_seen.value_or(0));
          back = std::max(back, trial.frames_until_back.value_or(0));
          ghost = std::max(ghost, trial.last_ghost_frame);
          gaps += trial.gaps;
          early += trial.early_gaps;
          wrong += trial.wrong;
        }
        std::printf("| %s%s | %.0f | %s | %.0f | %d | %d | %d%s | %d, %d | %d |\n", test::spelled(code).c_str(),
                    square ? "on-off" : "", speed, yes(input), light, first, ghost, back,
                    never ? (" (never: " + std::to_string(never) + ")").c_str() : "", gaps, early, wrong);
        std::fflush(stdout);
      }
    }
  }
}

std::string spelled(const std::map<ToneSet, long>& codes) {
  std::string text;
  for (const auto& [code, times] : codes) {
    text += test::spelled(code) + "(" + std::to_string(times) + ") ";
  }
  return text;
}

void report_lamps() {
  std::printf(
      "\n## Lamps\n\nAisles, 60 frames/s, mains of 50 and 60 Hz in turn. Each lamp in view is a chance in each frame: "
      "lamp-hours. Among the lamps hang beacons of a planned site, 5.5 m apart in two rows; all within 15 m are heard, "
      "one "
      "in four shines. Sightings: of no beacon. Nameable: in a code that plan_codes gives, two tones, none a multiple "
      "of "
      "the other. Named alone: without a receiver, on a site that has every code of one to three tones once. Right and "
      "wrong: names that the shipped line gives, before a pose is known, by announcements / and by place once it "
      "is.\n\n| lamps | m/s | motion input | frames | lamp-hours | sightings | nameable | named alone | right | wrong "
      "| "
      "codes, Hz (times) |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& [lamps, name] : test::kAllLamps) {
    for (const double speed : {0., 0.5, 1., 2., 5.}) {
      for (const bool input : {true, false}) {
        test::HallOfLamps hall;
        hall.lamps = lamps;
        hall.speed_m_s = speed;
        hall.motion_input = input;
        for (int run = 0; run < scaled(8); ++run) {
          hall.mains_hz = run % 2 == 0 ? 50 : 60;
          hall.run(8, static_cast<unsigned>(run));
        }
        std::printf("| %s | %.1f | %s | %ld | %.2f | %ld | %ld | %ld | %ld / %ld | %ld / %ld | %s|\n", name, speed,
                    yes(input), hall.frames, static_cast<double>(hall.lamps_in_view) / test::kPlanRate_hz / 3600,
                    hall.sightings, hall.nameable(), hall.named_alone, hall.heard.right, hall.located.right,
                    hall.heard.wrong, hall.located.wrong, spelled(hall.codes).c_str());
        std::fflush(stdout);
      }
    }
  }
}

}  // namespace
}  // namespace lodestar

int main(int argc, char** argv) {
  std::set<std::string> wanted;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--scale") == 0 && i + 1 < argc) {
      lodestar::scale = std::atof(argv[++i]);
    } else {
      wanted.insert(argv[i]);
    }
  }
  const std::pair<const char*, void (*)()> sections[] = {{"probability", lodestar::report_probability},
                                                         {"alarms", lodestar::report_alarms},
                                                         {"centre", lodestar::report_centre},
                                                         {"range", lodestar::report_range},
                                                         {"motion", lodestar::report_motion},
                                                         {"follow", lodestar::report_follow},
                                                         {"lamps", lodestar::report_lamps}};
  std::printf("# Detection: its limits\n\n`report_detector --scale %g`\n", lodestar::scale);
  for (const auto& [name, report] : sections) {
    if (wanted.empty() || wanted.count(name)) report();
  }
}
