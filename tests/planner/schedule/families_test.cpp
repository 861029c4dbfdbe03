#include "planner/schedule/families.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/planner/schedule/sequences.hpp"

namespace drapeplan {
namespace {

using test::article_frame;
using test::expect_sound;
using test::last_end;

/// All ways to spread the four values.
std::vector<StrokeSpreads> all_spreads() {
  const std::optional<Spread> none, smooth = Spread::smooth, each = Spread::each;
  return {{},
          {.start = each, .height = each},
          {.start = smooth, .height = each, .bend = smooth, .leave = smooth},
          {.start = each, .height = none, .bend = each, .leave = each},
          {.start = none, .height = smooth}};
}

void expect_equal(const Strokes& a, const Strokes& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (size_t g = 0; g < a.size(); ++g) {
    for (double Stroke::*value :
         {&Stroke::start, &Stroke::duration, &Stroke::height, &Stroke::leave, &Stroke::bend})
      EXPECT_LE(std::abs(a[g].*value - b[g].*value), tolerance) << g;
  }
}

TEST(WaveFamily, EveryMemberIsSoundAndNotTooLong) {
  const SequenceFrame frame = article_frame();
  const WaveFamily waves(frame);
  for (int k = 0; k < 200; ++k) {
    const Strokes wave = waves.decode(even_point(k, WaveFamily::kDimension));
    expect_sound(frame, wave);
    EXPECT_LE(last_end(wave), frame.longest_sequence + 1e-9);
  }
}

TEST(WaveFamily, HoldsTheBaselines) {
  const SequenceFrame frame = article_frame();
  const WaveFamily waves(frame);
  WaveParameters flat = baseline_wave(frame);
  flat.delay = 0;
  flat.duration = frame.options.uniform_duration;
  expect_equal(waves.decode(waves.encode(flat)), uniform_strokes(frame), 1e-12);
  expect_equal(waves.decode(waves.encode(baseline_wave(frame))), wave_strokes(frame), 1e-12);
}

TEST(WaveFamily, HasAMemberOnARigOfOneGripper) {
  SequenceFrame frame;
  frame.rig.columns = frame.rig.rows = 1;
  frame.rig.spacing = 0.1;
  frame.target_z = {0.01};
  expect_sound(frame, wave_strokes(frame));
  expect_sound(frame, WaveFamily(frame).decode(even_point(3, WaveFamily::kDimension)));
}

TEST(WaveFamily, HasNoMemberThatIsNotFinite) {
  SequenceFrame frame = article_frame();
  frame.options.preshape_height = 0;
  EXPECT_TRUE(WaveFamily(frame).encode(baseline_wave(frame)).allFinite());
  frame = article_frame();
  frame.options.wave_duration = frame.longest_sequence = 5.9;
  WaveParameters flat = baseline_wave(frame);
  flat.delay = 0;
  expect_sound(frame, WaveFamily(frame).decode(WaveFamily(frame).encode(flat)));
}

TEST(StrokeFamily, EveryMemberIsSoundAndNotTooLong) {
  SequenceFrame frame = article_frame();
  for (const std::optional<double> acceleration : {std::optional<double>(), std::optional(0.5)}) {
    frame.rig.max_acceleration = acceleration;
    for (const StrokeSpreads& spreads : all_spreads()) {
      const StrokeFamily family(frame, spreads);
      for (int k = 0; k < 100; ++k) {
        const Strokes strokes = family.decode(even_point(k, family.dimension()));
        expect_sound(frame, strokes);
        EXPECT_LE(last_end(strokes), frame.longest_sequence + 1e-9);
        for (const Stroke& stroke : strokes) EXPECT_GE(stroke.duration, frame.shortest_stroke - 1e-9);
      }
    }
  }
}

TEST(StrokeFamily, EncodesWhatItDecodes) {
  const SequenceFrame frame = article_frame();
  for (const StrokeSpreads& spreads : all_spreads()) {
    const StrokeFamily family(frame, spreads);
    for (int k = 1; k < 50; ++k) {
      // Near the middle nothing is clipped.
      const Eigen::VectorXd x = (0.5 + 0.1 * (even_point(k, family.dimension()).array() - 0.5)).matrix();
      const Strokes strokes = family.decode(x);
      expect_equal(family.decode(family.encode(strokes)), strokes, 1e-9);
    }
  }
}

TEST(StrokeFamily, TheFreeMemberIsWhatTheSmoothOneIs) {
  const SequenceFrame frame = article_frame();
  const StrokeFamily smooth(frame, {}), each(frame, {.start = Spread::each, .height = Spread::each});
  EXPECT_EQ(smooth.dimension(), 21);
  EXPECT_EQ(each.dimension(), 51);
  for (int k = 0; k < 50; ++k) {
    const Strokes strokes = smooth.decode(even_point(k, smooth.dimension()));
    expect_equal(each.decode(each.encode(strokes)), strokes, 1e-9);
  }
  for (const Strokes& base : {uniform_strokes(frame), wave_strokes(frame)})
    expect_equal(each.decode(each.encode(base)), base, 1e-9);
}

TEST(StrokeFamily, NeedsNoMoreNumbersForALargerRig) {
  SequenceFrame frame;
  frame.rig.spacing = 0.1;
  for (const auto& [columns, rows, numbers] :
       {std::array{10, 10, 21}, std::array{4, 3, 19}, std::array{2, 1, 5}, std::array{1, 1, 3}}) {
    frame.rig.columns = columns;
    frame.rig.rows = rows;
    frame.target_z.assign(size_t(frame.rig.count()), 0.05);
    const StrokeFamily family(frame, {});
    EXPECT_EQ(family.dimension(), numbers);
    expect_sound(frame, family.decode(even_point(1, family.dimension())));
  }
}

}  // namespace
}  // namespace drapeplan
