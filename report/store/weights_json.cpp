#include "report/store/weights_json.hpp"

#include <algorithm>

#include "calib/problem/known_sd.hpp"

namespace rigcal::report {

Json weights_json(const Result& result) {
  Json list = Json::array();
  for (const calib::ConditionScore& score : result.fit.conditions) {
    if (score.use != datasets::Use::fit) continue;
    const auto record = std::find_if(result.records.begin(), result.records.end(),
                                     [&](const auto& each) { return each.condition == score.id; });
    if (record == result.records.end()) continue;
    for (const calib::ChannelScore& channel : score.channels) {
      const auto series = record->channels.find(channel.channel);
      if (series == record->channels.end()) continue;
      Json json;
      json["condition"] = score.id;
      json["channel"] = std::string(info(channel.channel).key);
      json["samples"] = score.samples;
      json["sd"] = number(calib::known_sd(result.campaign, channel.channel, series->second));
      json["rms"] = channel.agreement ? number(channel.agreement->rmse) : Json(nullptr);
      list.push_back(std::move(json));
    }
  }
  return list;
}

}  // namespace rigcal::report
