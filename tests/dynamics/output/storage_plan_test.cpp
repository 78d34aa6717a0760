#include "dynamics/output/storage_plan.h"

#include <algorithm>

#include "tests/catch.h"

using namespace sprung::dynamics;
using Catch::Matchers::WithinRel;

namespace {

using Which = StorageRequest::Which;

// 10,001 outputs of 8 bytes: 0.08 MB for a column.
using enum StoredGroup;
constexpr auto kMotion = StoredHistory::Kind::kMotion, kPlace = StoredHistory::Kind::kPlace;
const std::vector<StoredHistory> kHistories{
    {"/time", 1},
    {"/points/frame.seat/acceleration", 20, kPoints, "frame.seat"},
    {"/points/frame.front/acceleration", 20, kPoints, "frame.front"},
    {"/points/blade.tip/acceleration", 20, kPoints, "blade.tip"},
    {"/bodies/frame/position", 10, kBodies, "frame", kMotion},
    {"/bodies/frame/acceleration", 10, kBodies, "frame"},
    {"/bodies/frame/center_of_mass/position", 20, kPoints, "frame.center_of_mass", kMotion},
    {"/joints/pivot/reaction", 20, kJoints, "pivot"},
    {"/forces/tyre/force", 10, kForces, "tyre"},
    {"/forces/tyre/length", 10, kForces, "tyre", kPlace},
    {"/forces/tyre/on_wheel", 20, kWrenches, "tyre"},
    {"/recovery/frame/moment", 40, kRecovery, "frame"},
    {"/energy/kinetic", 1},
};

const StoredHistory& history(const std::string& name) {
  return *std::find_if(kHistories.begin(), kHistories.end(),
                       [&](const StoredHistory& one) { return one.name == name; });
}

StoragePlan make_plan(const OutputSettings& settings) {
  return StoragePlan(settings, kHistories,
                     {.num_outputs = 10001.0,
                      .output_step = 1e-3,
                      .reported = {"frame.seat"},
                      .stiffened_bodies = {"blade"}});
}

// A column of 10,001 rows in each precision, and what HDF5 takes for a dataset [MB].
constexpr double kOfDouble = 0.080008, kOfSingle = 0.0290029, kOfRounded = 0.0240024, kOfDataset = 0.0008;

}  // namespace

TEST_CASE("What fits into the size is stored at every output in double precision") {
  const StoragePlan plan = make_plan({});
  for (const StoredHistory& one : kHistories) {
    CHECK(plan.every(one) == 1);
    CHECK(plan.precision(one) == StoredPrecision::kDouble);
  }
  CHECK_THAT(plan.size(), WithinRel(202 * kOfDouble + 13 * kOfDataset, 1e-9));
  CHECK(plan.reductions().empty());
  CHECK(describe_storage(plan, {}) == "about 16 MB");
}

TEST_CASE("What does not fit is reduced step by step, and no further than needed") {
  OutputSettings settings;
  settings.size = 15.0;  // without two of the points
  StoragePlan plan = make_plan(settings);
  CHECK(plan.every(history("/points/frame.seat/acceleration")) == 1);
  CHECK(plan.every(history("/points/frame.front/acceleration")) == 0);
  CHECK(plan.every(history("/bodies/frame/center_of_mass/position")) == 0);
  CHECK(plan.every(history("/points/blade.tip/acceleration")) ==
        1);  // it does not follow from the body's motion
  CHECK(plan.precision(history("/points/frame.seat/acceleration")) == StoredPrecision::kDouble);
  CHECK_THAT(plan.size(), WithinRel(162 * kOfDouble + 11 * kOfDataset, 1e-9));

  settings.size = 5.0;
  plan = make_plan(settings);
  CHECK(plan.precision(history("/points/frame.seat/acceleration")) == StoredPrecision::kSingle);
  CHECK(plan.precision(history("/time")) == StoredPrecision::kDouble);
  CHECK(plan.precision(history("/energy/kinetic")) == StoredPrecision::kDouble);
  CHECK(plan.every(history("/recovery/frame/moment")) == 1);
  CHECK_THAT(plan.size(), WithinRel(2 * kOfDouble + 160 * kOfSingle + 11 * kOfDataset, 1e-9));

  settings.size = 4.5;
  plan = make_plan(settings);
  CHECK(plan.precision(history("/recovery/frame/moment")) == StoredPrecision::kRounded);
  CHECK(plan.precision(history("/bodies/frame/acceleration")) == StoredPrecision::kRounded);
  CHECK(plan.precision(history("/bodies/frame/position")) == StoredPrecision::kSingle);
  CHECK(plan.precision(history("/forces/tyre/length")) == StoredPrecision::kSingle);
  CHECK(plan.precision(history("/energy/kinetic")) == StoredPrecision::kDouble);
  CHECK(plan.every(history("/recovery/frame/moment")) == 1);
  CHECK_THAT(plan.size(),
             WithinRel(2 * kOfDouble + 20 * kOfSingle + 140 * kOfRounded + 11 * kOfDataset, 1e-9));

  settings.size = 4.0;
  plan = make_plan(settings);
  CHECK(plan.every(history("/recovery/frame/moment")) == 10);
  CHECK(plan.every(history("/joints/pivot/reaction")) == 1);

  settings.size = 3.0;
  plan = make_plan(settings);
  CHECK(plan.every(history("/joints/pivot/reaction")) == 10);
  CHECK(plan.every(history("/forces/tyre/on_wheel")) == 10);
  CHECK(plan.every(history("/bodies/frame/position")) == 1);

  settings.size = 1.0;  // which cannot be reached
  plan = make_plan(settings);
  CHECK(plan.every(history("/forces/tyre/force")) == 1);
  CHECK(plan.every(history("/bodies/frame/position")) == 10);
  CHECK(plan.every(history("/bodies/frame/acceleration")) == 1);
  CHECK(plan.every(history("/points/frame.seat/acceleration")) == 1);
  CHECK_THAT(plan.size(),
             WithinRel(2 * kOfDouble + 11 * kOfSingle + 68 * kOfRounded + 11 * kOfDataset, 1e-9));
  CHECK(describe_storage(plan, settings) ==
        "about 2.1 MB; for output.size = 1 MB, which is not reached: only points of the summary (the tools "
        "compute the others); "
        "single precision; forces, accelerations and rates to five digits; stress resultants every 10 ms; "
        "reactions of joints and loads of force elements every 10 ms; positions and velocities every 10 ms");
}

TEST_CASE("What is thinned out is told with the interval at which it is stored") {
  OutputSettings settings;
  settings.size = 1e-4;
  const StoragePlan plan(
      settings, kHistories,
      {.num_outputs = 10001.0, .output_step = 4e-3, .reported = {}, .stiffened_bodies = {}});
  CHECK(plan.every(history("/recovery/frame/moment")) == 3);
  CHECK(describe_storage(plan, settings).find("stress resultants every 12 ms") != std::string::npos);
}

TEST_CASE("What the run file asks for is stored, however large it is") {
  OutputSettings settings;
  settings.size = 1.0;
  settings.precision = StoredPrecision::kDouble;
  settings.groups[static_cast<std::size_t>(StoredGroup::kPoints)].which = Which::kAll;
  settings.groups[static_cast<std::size_t>(StoredGroup::kBodies)].every = 3;
  settings.groups[static_cast<std::size_t>(StoredGroup::kRecovery)].every = 5;
  settings.groups[static_cast<std::size_t>(StoredGroup::kForces)] = {
      .which = Which::kListed, .names = {"spring"}, .locations = {}, .every = {}};
  settings.groups[static_cast<std::size_t>(StoredGroup::kJoints)].which = Which::kNone;
  const StoragePlan plan = make_plan(settings);
  CHECK(plan.precision(history("/bodies/frame/position")) == StoredPrecision::kDouble);
  CHECK(plan.every(history("/bodies/frame/position")) == 3);
  CHECK(plan.every(history("/bodies/frame/acceleration")) == 3);
  CHECK(plan.every(history("/points/frame.front/acceleration")) == 1);
  CHECK(plan.every(history("/recovery/frame/moment")) == 5);
  CHECK(plan.every(history("/forces/tyre/force")) == 0);
  CHECK(plan.every(history("/forces/tyre/on_wheel")) == 10);
  CHECK(plan.every(history("/joints/pivot/reaction")) == 0);
}
