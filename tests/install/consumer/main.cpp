// Prints a superelement's name, and its frequencies in Hz.
#include <cstdio>

#include "reduce/superelement/superelement.h"

int main(int, char** arguments) {
  const sprung::reduce::Superelement body = sprung::reduce::read_superelement(arguments[1]);
  std::printf("%s", body.name.c_str());
  for (const double frequency : body.frequency_hz) std::printf(" %.4f", frequency);
  std::printf("\n");
}
