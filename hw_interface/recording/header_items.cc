#include "vmech/hw_interface/recording/header_items.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <stdexcept>

namespace vmech {
namespace {

/// The fields of HandlePhysics in the order of a file.
template <typename Physics>
auto FieldsOf(Physics& handle) {
  return std::array{&handle.mass,       &handle.damping, &handle.coulomb,
                    &handle.resolution, &handle.peak,    &handle.max_speed};
}

std::string PhysicsText(const HandlePhysics& handle) {
  std::string text;
  for (const double* field : FieldsOf(handle)) {
    text += (text.empty() ? "" : " ") + fmt::to_string(*field);
  }
  return text;
}

std::string OneLine(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

void AddNumbered(const char* key, const std::vector<std::string>& names, HeaderItems* items) {
  for (size_t i = 0; i < names.size(); ++i)
    items->emplace_back(fmt::format("{} {}", key, i), names[i]);
}

/// Takes the next word off a line.
std::string_view NextWord(std::string_view* line) {
  const std::string_view word = line->substr(0, line->find(' '));
  line->remove_prefix(std::min(line->size(), word.size() + 1));
  return word;
}

double NumberIn(std::string_view key, std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size()) return value;
  throw std::runtime_error(fmt::format("{}: '{}' is not a number", key, text));
}

HandlePhysics PhysicsIn(std::string_view key, std::string_view text) {
  HandlePhysics handle;
  for (double* field : FieldsOf(handle)) *field = NumberIn(key, NextWord(&text));
  if (!text.empty()) throw std::runtime_error(fmt::format("{}: more than six numbers", key));
  return handle;
}

std::vector<std::string>* ListOf(std::string_view key, RecordingHeader* header) {
  if (key == "channel") return &header->channels;
  if (key == "state") return &header->states;
  if (key == "coordinate") return &header->mechanism.coordinates;
  if (key == "velocity") return &header->mechanism.velocities;
  if (key == "joint") return &header->mechanism.joints;
  return nullptr;
}

/// False for any other key.
bool TakeDeviceItem(std::string_view key, std::string_view text, RecordedDevice* device) {
  if (key == "device") {
    device->device = text;
  } else if (key == "delay") {
    device->delay = NumberIn(key, text);
  } else if (key == "linear") {
    device->linear = PhysicsIn(key, text);
  } else if (key == "angular") {
    device->angular = PhysicsIn(key, text);
  } else {
    return false;
  }
  return true;
}

/// "2 device NAME", "2 delay 0.001", ..
void TakeHandItem(std::string_view line, RecordingHeader* header) {
  constexpr double kMostHands = 8;
  const double hand = NumberIn("hand", NextWord(&line));
  const std::string_view item = NextWord(&line);
  if (hand >= 2 && hand <= kMostHands) {
    const auto index = static_cast<size_t>(hand - 2);
    if (header->others.size() <= index) header->others.resize(index + 1);
    if (TakeDeviceItem(item, line, &header->others[index])) return;
  }
  throw std::runtime_error(fmt::format(
      "'hand {:g} {}': device, delay, linear or angular of hand 2 to 8 expected", hand, item));
}

void MakePlain(std::vector<std::string>* names) {
  for (std::string& name : *names) {
    for (char& c : name) {
      const bool plain = static_cast<unsigned char>(c) >= ' ' && c != ',' && c != '"' && c != '\\';
      if (!plain) c = ';';
    }
  }
}

}  // namespace

HeaderItems ItemsOf(const RecordingHeader& header) {
  HeaderItems items{{"device", OneLine(header.device)},
                    {"period", fmt::to_string(header.period)},
                    {"delay", fmt::to_string(header.delay)},
                    {"linear", PhysicsText(header.linear)},
                    {"angular", PhysicsText(header.angular)}};
  for (int i = 1; i < header.hands(); ++i) {
    const RecordedDevice& other = header.others[static_cast<size_t>(i - 1)];
    const auto add = [&](const char* key, const std::string& text) {
      items.emplace_back(fmt::format("hand {} {}", i + 1, key), text);
    };
    add("device", OneLine(other.device));
    add("delay", fmt::to_string(other.delay));
    add("linear", PhysicsText(other.linear));
    add("angular", PhysicsText(other.angular));
  }
  for (const auto& [key, text] : header.notes) items.emplace_back("note " + key, OneLine(text));
  AddNumbered("coordinate", header.mechanism.coordinates, &items);
  AddNumbered("velocity", header.mechanism.velocities, &items);
  AddNumbered("joint", header.mechanism.joints, &items);
  AddNumbered("channel", header.channels, &items);
  AddNumbered("state", header.states, &items);
  return items;
}

void TakeItem(std::string_view line, RecordingHeader* header) {
  const std::string_view key = NextWord(&line);
  if (TakeDeviceItem(key, line, header)) return;
  if (key == "hand") {
    TakeHandItem(line, header);
  } else if (key == "period") {
    header->period = NumberIn(key, line);
  } else if (key == "note") {
    const std::string_view note = NextWord(&line);
    header->notes.emplace_back(note, line);
  } else if (std::vector<std::string>* list = ListOf(key, header)) {
    NextWord(&line);
    list->emplace_back(line);
  } else {
    throw std::runtime_error(
        fmt::format("'{}': device, period, delay, linear, angular, note, coordinate, velocity, "
                    "joint, channel or state expected",
                    key));
  }
}

RecordingHeader WithPlainNames(RecordingHeader header) {
  MakePlain(&header.channels);
  MakePlain(&header.states);
  MakePlain(&header.mechanism.coordinates);
  MakePlain(&header.mechanism.velocities);
  MakePlain(&header.mechanism.joints);
  return header;
}

}  // namespace vmech
