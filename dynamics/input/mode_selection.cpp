#include "dynamics/input/mode_selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "tools/support/terminal/text_table.h"

namespace sprung::dynamics {

namespace {

constexpr int kMostModes = std::numeric_limits<int>::max();

ModeRequest read_mode_request(const support::TomlValue& value) {
  ModeRequest request;
  request.key = value.key();
  request.location = value.location();
  if (value.is_integer()) {
    request.count = static_cast<int>(value.integer(0, kMostModes));
  } else if (value.is_array()) {
    request.kind = ModeRequest::Kind::kNumbers;
    for (const support::TomlValue& item : value.items()) {
      const int number = static_cast<int>(item.integer(1, kMostModes));
      if (!request.numbers.empty() && number <= request.numbers.back()) {
        throw item.error(
            fmt::format("must ascend: mode {} comes after mode {}", number, request.numbers.back()));
      }
      request.numbers.push_back(number);
    }
  } else if (value.is_string() && value.string() == "all") {
    request.kind = ModeRequest::Kind::kAll;
  } else if (value.is_string() && value.string() == "auto") {
    request.kind = ModeRequest::Kind::kAuto;
  } else if (value.is_string() && value.string() == "certified") {
    request.kind = ModeRequest::Kind::kCertified;
  } else {
    throw value.error(
        fmt::format("must be a number of modes, a list of mode numbers, \"all\", \"auto\" or "
                    "\"certified\"{}",
                    value.is_string() ? fmt::format(", got \"{}\"", value.string()) : ""));
  }
  return request;
}

[[noreturn]] void refuse(const support::SourceLocation& location, const std::string& key,
                         const std::string& message) {
  throw support::InputError(location, fmt::format("'{}' {}", key, message));
}

// The first and last mode, 1-based, that share the frequency of a mode.
std::pair<int, int> find_cluster(const reduce::Superelement& superelement, int number) {
  const int cluster = superelement.cluster[number - 1];
  int first = number, last = number;
  while (first > 1 && superelement.cluster[first - 2] == cluster) --first;
  while (last < superelement.num_modes() && superelement.cluster[last] == cluster) ++last;
  return {first, last};
}

std::vector<int> resolve_count(const ModeRequest& request, const reduce::Superelement& superelement) {
  if (request.count > 0) {
    const auto [first, last] = find_cluster(superelement, request.count);
    if (last != request.count) {
      refuse(request.location, request.key,
             fmt::format("is {}, which separates modes {} to {} of one frequency, {:.6g} Hz; take {} or {} "
                         "modes, or list their numbers",
                         request.count, first, last, superelement.frequency_hz[request.count - 1], first - 1,
                         last));
    }
  }
  std::vector<int> numbers(static_cast<std::size_t>(request.count));
  std::iota(numbers.begin(), numbers.end(), 1);
  return numbers;
}

// A basis is certified as a whole: its bound is that of all its vectors.
void require_certificate(const ModeRequest& request, const reduce::Superelement& superelement) {
  if (superelement.certificate && superelement.certificate->is_bounded()) return;
  const std::string reason = superelement.certificate
                                 ? fmt::format("whose certificate has no bound up to {:.6g} Hz",
                                               superelement.certificate->highest_hz)
                                 : "which has no certificate";
  refuse(request.location, request.key,
         fmt::format("asks for the certified basis of superelement '{}', {}; make it with the basis \"free\"",
                     superelement.name, reason));
}

std::vector<int> resolve_request(const ModeRequest& request, const reduce::Superelement& superelement) {
  const int available = superelement.num_modes();
  if (request.kind == ModeRequest::Kind::kCertified) require_certificate(request, superelement);
  if (request.kind != ModeRequest::Kind::kCount && request.kind != ModeRequest::Kind::kNumbers) {
    std::vector<int> numbers(static_cast<std::size_t>(available));
    std::iota(numbers.begin(), numbers.end(), 1);
    return numbers;
  }
  const bool by_count = request.kind == ModeRequest::Kind::kCount;
  const int highest = by_count ? request.count : request.numbers.empty() ? 0 : request.numbers.back();
  if (highest > available) {
    const std::string wanted = by_count ? support::format_count(static_cast<std::size_t>(highest), "mode")
                                        : fmt::format("mode {}", highest);
    refuse(request.location, request.key,
           fmt::format("asks for {}, but superelement '{}' has {}", wanted, superelement.name,
                       support::format_count(static_cast<std::size_t>(available), "mode")));
  }
  return by_count ? resolve_count(request, superelement) : request.numbers;
}

}  // namespace

const reduce::Superelement& find_superelement(const std::string& body_name, const std::string& key,
                                              const support::SourceLocation& location,
                                              const Vehicle& vehicle) {
  const BodyDescription* body = vehicle.find_body(body_name);
  if (body == nullptr) {
    refuse(location, key,
           fmt::format("is about no body of the vehicle: there is no '{}'{}", body_name,
                       support::nearest_name_hint(body_name, vehicle.body_names())));
  }
  const reduce::Superelement* superelement = vehicle.superelement_of(*body);
  if (superelement == nullptr) {
    refuse(location, key,
           fmt::format("is about the modes of body '{}', which has no superelement", body_name));
  }
  return *superelement;
}

ModeRequests read_modes(const support::TomlTable& table) {
  ModeRequests requests;
  for (const auto& [body, value] : table.entries()) requests.emplace(body, read_mode_request(value));
  return requests;
}

ModeChoiceSettings read_mode_choice(const support::TomlTable& table) {
  ModeChoiceSettings settings;
  settings.tolerance =
      table.number_or("tolerance", settings.tolerance, {.unit = "", .at_least = 0.0, .at_most = 0.5});
  table.reject_unknown_keys();
  return settings;
}

std::vector<std::string> list_automatic_bodies(const ModeRequests& requests) {
  std::vector<std::string> bodies;
  for (const auto& [body, request] : requests) {
    if (request.kind == ModeRequest::Kind::kAuto) bodies.push_back(body);
  }
  return bodies;
}

DampingRequests read_modal_damping(const support::TomlTable& table) {
  const support::Quantity ratio{.unit = "", .at_least = 0.0, .at_most = 1e6};
  DampingRequests requests;
  for (const auto& [body, value] : table.entries()) {
    const std::vector<double> ratios =
        value.is_array() ? value.numbers(ratio) : std::vector<double>{value.number(ratio)};
    requests.emplace(body,
                     DampingRequest{.ratios = ratios, .key = value.key(), .location = value.location()});
  }
  return requests;
}

ModeSelection resolve_modes(const ModeRequests& requests, const Vehicle& vehicle) {
  ModeSelection selection;
  for (const auto& [body, request] : requests) {
    const reduce::Superelement& superelement =
        find_superelement(body, request.key, request.location, vehicle);
    std::vector<int> numbers = resolve_request(request, superelement);
    if (!numbers.empty()) selection.emplace(body, std::move(numbers));
  }
  return selection;
}

ModalDamping resolve_modal_damping(const DampingRequests& requests, const ModeSelection& selection,
                                   const Vehicle& vehicle) {
  ModalDamping damping;
  for (const auto& [body, request] : requests) {
    find_superelement(body, request.key, request.location, vehicle);
    const auto active = selection.find(body);
    if (active == selection.end()) continue;
    const std::size_t num_modes = active->second.size();
    if (request.ratios.size() != 1 && request.ratios.size() != num_modes) {
      refuse(request.location, request.key,
             fmt::format("must be one ratio, or one for each of the {}; got {}",
                         support::format_count(num_modes, "available mode"), request.ratios.size()));
    }
    damping.emplace(body, request.ratios);
  }
  return damping;
}

ModalDamping keep_damping(const ModalDamping& damping, const ModeSelection& all, const ModeSelection& kept) {
  ModalDamping result;
  for (const auto& [body, ratios] : damping) {
    const auto kept_modes = kept.find(body);
    if (kept_modes == kept.end()) continue;
    std::vector<double>& kept_ratios = result[body];
    kept_ratios = ratios;
    if (ratios.size() == 1) continue;
    kept_ratios.clear();
    const std::vector<int>& numbers = all.at(body);
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (std::binary_search(kept_modes->second.begin(), kept_modes->second.end(), numbers[k])) {
        kept_ratios.push_back(ratios[k]);
      }
    }
  }
  return result;
}

}  // namespace sprung::dynamics
