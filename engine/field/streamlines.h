// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/evaluate/places.h"
#include "engine/scene/job.h"
#include "engine/scene/model.h"
#include "eval/streamlines/streamline.h"

namespace limn::engine {

/// What lines are drawn along a field. Lengths are the mesh's.
struct StreamlineOptions {
    std::optional<double> separation;  ///< D: lines that far apart, all over the surface
    std::optional<PlaceArrays> seeds;  ///< a line through each of these instead
    /// Of the integration. None: a quarter of the mean edge of the limit, or D/8 if that is less.
    std::optional<double> step;
    /// Of a line. None: any with a separation, else 10 times the diagonal of the bounding box.
    std::optional<double> maxLength;
    double stopDistance = 0.5;                  ///< of D: how near to another one a line may come
    bool isForwardOnly = false;                 ///< from seeds with the field only
    eval::TableEvaluator* evaluator = nullptr;  ///< as eval::FieldSurface
};

/// Lines along a field, their places on the mesh's faces.
struct Streamlines {
    std::vector<eval::Streamline> lines;
    std::optional<double> farthest;  ///< with a separation: eval::EvenLines
    double seconds = 0.0;

    size_t CountClosed() const;
    size_t CountPoints() const;
    double FindTotalLength() const;
    /// How many ends there are of each kind.
    std::array<size_t, eval::kNumStreamEnds> CountEnds() const;
    /// The lines' points; of a closed line the first one again at its end.
    std::vector<std::vector<Eigen::Vector3d>> ListPoints() const;
};

/// Draws lines along the limit field of a 1-form.
///
/// \param form        per edge of the mesh
/// \throws Error      BadOption: neither separation nor seeds; a number that is not positive; a
///                    separation of more than the mesh has, without seeds; a
///                    step of more than D/4, or so short that a line would have 2^27 of them;
///                    TooLarge: as eval::FillEvenly; as eval::FieldSurface
/// \throws PlaceError a seed that is no place of the limit
/// \throws Stopped
Streamlines TraceStreamlines(Model const& model, std::span<double const> form,
                             StreamlineOptions const& options, Job& job);

/// OBJ text: vertices and a line element each; that of a closed line ends with its first vertex.
std::string FormatLineElements(Streamlines const& streamlines, Precision precision);

/// CSV text `line,face,s,t,x,y,z,length`, (face,s,t) as LocatePlaces takes them; of a closed line
/// the first point comes again at its end.
std::string FormatLineTable(Model const& model, Streamlines const& streamlines,
                            Precision precision);

}  // namespace limn::engine
