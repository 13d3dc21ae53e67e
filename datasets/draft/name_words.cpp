#include "datasets/draft/name_words.hpp"

#include <array>

namespace rigcal::datasets {
namespace {

using Word = std::string_view;

constexpr std::array<Word, 13> kTime{"time",        "tout",    "timestamp", "zeit",     "messzeit",
                                     "temps",       "elapsed", "seconds",   "sekunden", "clock",
                                     "zeitstempel", "uhrzeit", "datetime"};

constexpr std::array<Word, 16> kReference{
    "ref",    "reference", "setpoint", "sp",  "set",      "target",      "desired", "des",
    "demand", "dem",       "soll",     "dmd", "sollwert", "sollgroesse", "vorgabe", "xd"};
constexpr std::array<Word, 4> kCommand{"cmd", "command", "drive", "commanded"};
constexpr std::array<Word, 23> kValve{
    "valve",        "control",    "uv",          "voltage",  "servo",    "duty",
    "stellgroesse", "stellgröße", "stellsignal", "ventil",   "spannung", "steuerspannung",
    "strom",        "current",    "joystick",    "solenoid", "pwm",      "servoventil",
    "servovalve",   "magnet",     "stellwert",   "sv",       "ventile"};
constexpr std::array<Word, 14> kMeasured{"encoder", "drehgeber", "resolver", "act", "actual",
                                         "ist",     "istwert",   "fb",       "fbk", "feedback",
                                         "meas",    "measured",  "gemessen", "fdbk"};
constexpr std::array<Word, 7> kError{"err",        "error",           "fehler",        "deviation",
                                     "abweichung", "regelabweichung", "regeldifferenz"};

constexpr std::array<Word, 19> kPosition{
    "pos",   "position", "stroke",     "disp",         "displacement", "weg",        "hub",
    "xp",    "lvdt",     "displ",      "travel",       "extension",    "auslenkung", "lage",
    "länge", "length",   "elongation", "verschiebung", "wegsensor"};
constexpr std::array<Word, 13> kAngle{"angle",        "theta",      "ang",           "phi",
                                      "winkel",       "tilt",       "schwenkwinkel", "jointangle",
                                      "gelenkwinkel", "drehwinkel", "rotation",      "inclinometer",
                                      "neigung"};
constexpr std::array<Word, 5> kForce{"force", "loadcell", "kraft", "kraftmessdose", "fl"};
constexpr std::array<Word, 9> kPressure{"pressure", "druck", "press",  "chamber", "kammer",
                                        "prs",      "dp",    "deltap", "port"};
constexpr std::array<Word, 6> kAcceleration{"acc",           "accel",          "acceleration",
                                            "accelerometer", "beschleunigung", "beschl"};
constexpr std::array<Word, 5> kTemperature{"temp", "temperature", "temperatur", "tmp", "toil"};
constexpr std::array<Word, 5> kVelocity{"vel", "velocity", "speed", "geschwindigkeit", "geschw"};
constexpr std::array<Word, 4> kFlow{"flow", "flowrate", "durchfluss", "volumenstrom"};
constexpr std::array<Word, 4> kTorque{"torque", "moment", "drehmoment", "trq"};
constexpr std::array<Word, 6> kRotation{"rpm",   "drehzahl", "revs",
                                        "omega", "gyro",     "winkelgeschwindigkeit"};

constexpr std::array<Word, 8> kSideA{"cap",   "head",       "bore",        "blind",
                                     "boden", "bodenseite", "kolbenseite", "kolbenraum"};
constexpr std::array<Word, 9> kSideB{"rod",       "annulus",      "ring",
                                     "stangen",   "stange",       "stangenseite",
                                     "ringseite", "kolbenstange", "ringraum"};
constexpr std::array<Word, 9> kSupply{"supply", "versorgungs", "system", "pump",    "pumpe",
                                      "pumpen", "versorgung",  "speise", "vordruck"};
constexpr std::array<Word, 5> kTank{"tank", "return", "rücklauf", "ruecklauf", "reservoir"};
constexpr std::array<Word, 9> kLoad{"load",       "last",      "delta",  "diff", "differential",
                                    "difference", "differenz", "deltap", "dp"};
constexpr std::array<Word, 4> kPilot{"pilot", "ppilot", "vorsteuer", "steuerdruck"};
constexpr std::array<Word, 8> kBase{"base",  "ground", "foundation", "frame",
                                    "floor", "boden",  "fundament",  "rahmen"};
constexpr std::array<Word, 4> kPayload{"payload", "specimen", "nutzlast", "prüfling"};
constexpr std::array<Word, 4> kPiston{"piston", "kolben", "cylinder", "zylinder"};
// A valve has a signal, and a spool whose position is not that of the piston.
constexpr std::array<Word, 7> kSpool{"spool",  "schieber",    "ventilschieber", "valve",
                                     "ventil", "servoventil", "servovalve"};
constexpr std::array<Word, 25> kFiller{
    "shaft",    "welle", "rotor",  "vane",   "extern",    "external", "reaction", "rack",  "oil",
    "oel",      "öl",    "sensor", "signal", "value",     "wert",     "side",     "seite", "axial",
    "actuator", "joint", "gelenk", "arm",    "anschluss", "cell",     "raum"};

constexpr std::array kRows{
    WordRow{Meaning::time, kTime},
    WordRow{Meaning::reference, kReference},
    WordRow{Meaning::command, kCommand},
    WordRow{Meaning::valve, kValve},
    WordRow{Meaning::measured, kMeasured},
    WordRow{Meaning::error, kError},
    WordRow{Meaning::position, kPosition},
    WordRow{Meaning::angle, kAngle},
    WordRow{Meaning::force, kForce},
    WordRow{Meaning::pressure, kPressure},
    WordRow{Meaning::acceleration, kAcceleration},
    WordRow{Meaning::temperature, kTemperature},
    WordRow{Meaning::velocity, kVelocity},
    WordRow{Meaning::flow, kFlow},
    WordRow{Meaning::torque, kTorque},
    WordRow{Meaning::rotation, kRotation},
    WordRow{Meaning::side_a, kSideA},
    WordRow{Meaning::side_b, kSideB},
    WordRow{Meaning::supply, kSupply},
    WordRow{Meaning::tank, kTank},
    WordRow{Meaning::load, kLoad},
    WordRow{Meaning::pilot, kPilot},
    WordRow{Meaning::base, kBase},
    WordRow{Meaning::payload, kPayload},
    WordRow{Meaning::piston, kPiston},
    WordRow{Meaning::spool, kSpool},
    WordRow{Meaning::filler, kFiller},
};

constexpr std::array kQuantitySymbols{
    Symbol{'t', Meaning::time},         Symbol{'r', Meaning::reference},
    Symbol{'u', Meaning::valve},        Symbol{'x', Meaning::position},
    Symbol{'y', Meaning::position},     Symbol{'s', Meaning::position},
    Symbol{'p', Meaning::pressure},     Symbol{'f', Meaning::force},
    Symbol{'a', Meaning::acceleration}, Symbol{'v', Meaning::velocity},
    Symbol{'q', Meaning::flow}};

constexpr std::array kPressurePlaces{
    Symbol{'a', Meaning::side_a}, Symbol{'b', Meaning::side_b}, Symbol{'1', Meaning::side_a},
    Symbol{'2', Meaning::side_b}, Symbol{'s', Meaning::supply}, Symbol{'0', Meaning::supply},
    Symbol{'p', Meaning::supply}, Symbol{'t', Meaning::tank},   Symbol{'l', Meaning::load}};

}  // namespace

std::span<const WordRow> name_words() { return kRows; }
std::span<const Symbol> quantity_symbols() { return kQuantitySymbols; }
std::span<const Symbol> pressure_places() { return kPressurePlaces; }

}  // namespace rigcal::datasets
