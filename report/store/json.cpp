#include "report/store/json.hpp"

#include "report/json/described.hpp"

namespace rigcal::report {

std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string json_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json parameters_json(model::PlantKind plant) {
  Json list = Json::array();
  for (const model::ParameterSpec& spec : model::parameter_table(plant)) {
    Json json;
    json["key"] = std::string(spec.key);
    json["name"] = std::string(spec.name);
    json["symbol"] = std::string(spec.symbol);
    json["unit"] = std::string(spec.unit);
    json["default"] = json_of(spec.default_value);
    json["lower"] = json_of(spec.lower);
    json["upper"] = json_of(spec.upper);
    json["kind"] = std::string(to_string(spec.kind));
    json["can_be_fitted"] = spec.can_be_fitted;
    json["meaning"] = std::string(spec.meaning);
    json["source"] = std::string(spec.source);
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace rigcal::report
