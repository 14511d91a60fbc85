// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/field/circulation.h"
#include "engine/field/field.h"

namespace limn::cli {

/// What a field is written as, which its file's name says.
enum class FieldOutput { Mesh, Edges, Faces, Values, Integrals, Along };

/// \throws Error  BadOption: a name that says none of them
FieldOutput FindFieldOutput(std::string const& path);

/// The file of vectors beside a mesh.
std::string NameVectors(std::string const& mesh);

/// \param element  "vertex" or "face", the first column
std::string FormatVectors(char const* element, std::vector<std::array<double, 3>> const& vectors,
                          Precision precision);

/// `vertex,value`
std::string FormatFunction(std::span<double const> values);

/// `face,value,density` of the field's curl on its mesh: over the face, and per unit of area.
///
/// \throws Error  as far_ext::FindHodgeStars
std::string FormatIntegrals(engine::Field const& field);

/// `v0,v1,value`: circulations along edges, in the direction in which they were listed.
std::string FormatAlong(std::span<engine::EdgeCirculation const> along);

void AddToReport(nlohmann::json& report, engine::FieldAudit const& audit);

}  // namespace limn::cli
