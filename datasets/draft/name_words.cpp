#include "datasets/draft/name_words.hpp"

#include <array>

namespace rigcal::datasets {
namespace {

using Word = std::string_view;

constexpr std::array<Word, 16> kTime{
    "time",     "tout",  "timestamp",   "zeit",    "messzeit", "temps",      "elapsed", "seconds",
    "sekunden", "clock", "zeitstempel", "uhrzeit", "datetime", "timestamps", "tiempo",  "tempo"};

constexpr std::array<Word, 19> kReference{
    "ref",     "reference", "setpoint", "sp",       "set",        "target",   "desired",
    "des",     "demand",    "dem",      "soll",     "dmd",        "sollwert", "sollgroesse",
    "vorgabe", "xd",        "consigne", "consigna", "riferimento"};
constexpr std::array<Word, 7> kCommand{"cmd",      "command", "drive",      "commanded",
                                       "commande", "comando", "ansteuerung"};
constexpr std::array<Word, 38> kValve{
    "valve",        "control",      "uv",          "voltage",      "servo",    "duty",
    "stellgroesse", "stellgröße",   "stellsignal", "ventil",       "spannung", "steuerspannung",
    "strom",        "current",      "joystick",    "solenoid",     "pwm",      "servoventil",
    "servovalve",   "magnet",       "stellwert",   "sv",           "ventile",  "ventilansteuerung",
    "spule",        "vanne",        "servovanne",  "distributeur", "valvula",  "servovalvula",
    "valvola",      "servovalvola", "corriente",   "corrente",     "courant",  "tensione",
    "bobine",       "bobina"};
constexpr std::array<Word, 25> kMeasured{
    "encoder",  "drehgeber", "resolver", "act",   "actual",   "ist",      "istwert",
    "fb",       "fbk",       "feedback", "meas",  "measured", "gemessen", "fdbk",
    "mesure",   "mesuree",   "reel",     "real",  "medido",   "medida",   "misurato",
    "misurata", "attuale",   "actuelle", "effort"};
constexpr std::array<Word, 11> kElectric{
    "voltage",  "spannung", "steuerspannung", "strom", "current", "corriente",
    "corrente", "courant",  "tensione",       "pwm",   "duty"};
constexpr std::array<Word, 12> kError{
    "err",        "error",           "fehler",         "deviation",
    "abweichung", "regelabweichung", "regeldifferenz", "erreur",
    "ecart",      "errore",          "schleppfehler",  "schleppabstand"};

constexpr std::array<Word, 27> kPosition{
    "pos",        "position",    "stroke",     "disp",     "displacement",   "weg",
    "hub",        "xp",          "lvdt",       "displ",    "travel",         "extension",
    "auslenkung", "lage",        "länge",      "length",   "elongation",     "verschiebung",
    "wegsensor",  "deplacement", "course",     "posicion", "desplazamiento", "carrera",
    "posizione",  "corsa",       "spostamento"};
constexpr std::array<Word, 15> kAngle{"angle",        "theta",      "ang",           "phi",
                                      "winkel",       "tilt",       "schwenkwinkel", "jointangle",
                                      "gelenkwinkel", "drehwinkel", "rotation",      "inclinometer",
                                      "neigung",      "angulo",     "angolo"};
constexpr std::array<Word, 7> kForce{"force", "loadcell", "kraft", "kraftmessdose",
                                     "fl",    "fuerza",   "forza"};
constexpr std::array<Word, 15> kPressure{"pressure", "druck",     "press",   "chamber", "kammer",
                                         "prs",      "dp",        "deltap",  "port",    "pression",
                                         "presion",  "pressione", "chambre", "camara",  "camera"};
constexpr std::array<Word, 8> kAcceleration{"acc",           "accel",          "acceleration",
                                            "accelerometer", "beschleunigung", "beschl",
                                            "aceleracion",   "accelerazione"};
constexpr std::array<Word, 6> kTemperature{"temp", "temperature", "temperatur",
                                           "tmp",  "toil",        "temperatura"};
constexpr std::array<Word, 9> kVelocity{"vel",     "velocity", "speed",   "geschwindigkeit",
                                        "geschw",  "velo",     "vitesse", "velocidad",
                                        "velocita"};
constexpr std::array<Word, 8> kFlow{"flow",        "flowrate", "durchfluss", "volumenstrom",
                                    "volumestrom", "debit",    "caudal",     "portata"};
constexpr std::array<Word, 5> kTorque{"torque", "moment", "drehmoment", "trq", "couple"};
constexpr std::array<Word, 6> kRotation{"rpm",   "drehzahl", "revs",
                                        "omega", "gyro",     "winkelgeschwindigkeit"};

constexpr std::array<Word, 8> kSideA{"cap",   "head",       "bore",        "blind",
                                     "boden", "bodenseite", "kolbenseite", "kolbenraum"};
constexpr std::array<Word, 9> kSideB{"rod",       "annulus",      "ring",
                                     "stangen",   "stange",       "stangenseite",
                                     "ringseite", "kolbenstange", "ringraum"};
constexpr std::array<Word, 17> kSupply{
    "supply",        "versorgungs", "system",   "pump",  "pumpe",        "pumpen",
    "versorgung",    "speise",      "vordruck", "sys",   "alimentation", "alimentacion",
    "alimentazione", "mandata",     "bomba",    "pompe", "pompa"};
constexpr std::array<Word, 9> kTank{"tank",   "return",  "rücklauf", "ruecklauf", "reservoir",
                                    "retour", "retorno", "ritorno",  "scarico"};
constexpr std::array<Word, 12> kLoad{"load",         "last",       "delta",     "diff",
                                     "differential", "difference", "differenz", "deltap",
                                     "dp",           "charge",     "carga",     "carico"};
constexpr std::array<Word, 5> kDifference{"delta", "diff", "difference", "differenz",
                                          "differential"};
constexpr std::array<Word, 9> kExternal{"ext",  "extern", "external",    "externe", "externa",
                                        "stör", "stoer",  "disturbance", "gegen"};
constexpr std::array<Word, 4> kPilot{"pilot", "ppilot", "vorsteuer", "steuerdruck"};
constexpr std::array<Word, 8> kBase{"base",  "ground", "foundation", "frame",
                                    "floor", "boden",  "fundament",  "rahmen"};
constexpr std::array<Word, 4> kPayload{"payload", "specimen", "nutzlast", "prüfling"};
constexpr std::array<Word, 8> kPiston{"piston", "kolben",   "cylinder", "zylinder",
                                      "verin",  "cilindro", "pistone",  "cyl"};
// A valve has a signal, and a spool whose position is not that of the piston.
constexpr std::array<Word, 13> kSpool{
    "spool", "schieber",   "ventilschieber", "valve",        "ventil",  "servoventil", "servovalve",
    "vanne", "servovanne", "valvula",        "servovalvula", "valvola", "servovalvola"};
constexpr std::array<Word, 34> kFiller{
    "shaft",  "welle",  "rotor",     "vane",   "reaction", "rack",    "oil",   "oel",      "öl",
    "sensor", "signal", "value",     "wert",   "side",     "seite",   "axial", "actuator", "joint",
    "gelenk", "arm",    "anschluss", "cell",   "raum",     "end",     "ende",  "boom",     "bucket",
    "stick",  "huile",  "olio",      "aceite", "kanal",    "channel", "rec"};

constexpr std::array kRows{
    WordRow{Meaning::time, kTime},
    WordRow{Meaning::reference, kReference},
    WordRow{Meaning::command, kCommand},
    WordRow{Meaning::valve, kValve},
    WordRow{Meaning::electric, kElectric},
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
    WordRow{Meaning::difference, kDifference},
    WordRow{Meaning::external, kExternal},
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

constexpr std::array<Word, 2> kTypePrefixes{"r", "f"};  // real, float

}  // namespace

std::span<const WordRow> name_words() { return kRows; }
std::span<const Symbol> quantity_symbols() { return kQuantitySymbols; }
std::span<const Symbol> pressure_places() { return kPressurePlaces; }
std::span<const std::string_view> type_prefixes() { return kTypePrefixes; }

}  // namespace rigcal::datasets
