#pragma once

namespace stipple {

class Config;

/// Options of the method `reddy2011`. docs/decoder_published.md says which values the paper gives.
struct Reddy2011Options {
    int levels = 3;                 ///< of the wavelet transform, at most
    float wavelet_weight = 0.004F;  ///< lambda, flux
    float first_weight = 0.1F;      ///< lambda of the first iteration without flow
    float flow_weight = 1;          ///< beta
    float min_confidence = 0.6F;    ///< of the flow; exp(-1/2) is an inconsistency of 1 pixel
    int first_iterations = 100;     ///< without flow
    int rounds = 3;                 ///< of flow and minimisation along it
    int iterations = 60;            ///< in each round
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, Reddy2011Options& options);

}  // namespace stipple
