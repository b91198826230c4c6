//! The table of the rules: what each leaves out, why that is safe, and what guards it.

use super::rule::{Kind, Rule, RuleId};
use super::rules as decide;

/// Every rule, in the order of their numbers.
pub const RULES: [Rule; 30] = [
    Rule {
        id: RuleId::K1,
        leaves_out: "modes, inertia relief, damping and the mass matrix, where statics is all that is asked",
        kind: Kind::WithinBars,
        because: "K̂ = ΨᵀKΨ of constraint modes does not contain M (29), but for the rounding of the rigid-body motions that correct them",
        guard: "M-10: the static solutions are in equilibrium; M-17: the stiffness of each interface by other solves",
        decide: decide::k1,
    },
    Rule {
        id: RuleId::K2,
        leaves_out: "the constraint modes, where the interface stiffness is all that is asked",
        kind: Kind::WithinBars,
        because: "with the interface last, what elimination leaves of K is K̂",
        guard: "M-32: K̂v of random v against the forces of the whole model under that motion",
        decide: decide::k2,
    },
    Rule {
        id: RuleId::K3,
        leaves_out: "free modes and their factor, where the method keeps modes of the held interface",
        kind: Kind::Always,
        because: "(38) uses modes of the held interface alone",
        guard: "M-06: a count under the boundary of the modes",
        decide: decide::k3,
    },
    Rule {
        id: RuleId::K4,
        leaves_out: "held modes and a second ordering, where the method keeps free modes",
        kind: Kind::Always,
        because: "the factor of K_II and the Schur complement of the interface solve with K on all dofs, at shift zero",
        guard: "the residual of that operator, beyond which K − σM is factored; M-01",
        decide: decide::k4,
    },
    Rule {
        id: RuleId::K5,
        leaves_out: "attachment modes and their inverse at the interface, of Rubin's method",
        kind: Kind::Always,
        because: "they span Herting's space (50); the 6 × 6 matrix of inertia relief takes the place of A_B⁻¹",
        guard: "M-22: the attachment modes made from the reduced matrices",
        decide: decide::k5,
    },
    Rule {
        id: RuleId::K6,
        leaves_out: "the eigensolution of rigid-body modes, where coordinates are known",
        kind: Kind::Always,
        because: "the six unit motions of the coordinates are those modes (8)",
        guard: "M-05: energy and force of each in K; where it fails they come from the matrices",
        decide: decide::k6,
    },
    Rule {
        id: RuleId::K7,
        leaves_out: "rigid-body modes and all that is made of them, of a held component",
        kind: Kind::Always,
        because: "n_r = 0: K has no null space",
        guard: "the factor of K_II is definite; M-12: K̂ has no zero modes that are not accounted for",
        decide: decide::k7,
    },
    Rule {
        id: RuleId::K8,
        leaves_out: "interface dofs that nothing is connected to",
        kind: Kind::WithinBars,
        because: "no force acts on them, so that they follow the others as internal dofs do; statics of the rest is unchanged",
        guard: "M-10: no force is left on them in any static solution",
        decide: decide::k8,
    },
    Rule {
        id: RuleId::K9,
        leaves_out: "interface dofs at rest, with their rows and columns of K and M",
        kind: Kind::Always,
        because: "a dof that is zero takes no part in energies; its elimination is exact",
        guard: "M-10: every other row is in equilibrium; M-12: the motions that they hold are gone",
        decide: decide::k9,
    },
    Rule {
        id: RuleId::K10,
        leaves_out: "deformation of the interface, where interfaces move as parts of one rigid body",
        kind: Kind::Always,
        because: "motions of a rigid body are six; where they are all of the interface, Ψ_S U_B = U_I (24) gives Ψ_S without a solve",
        guard: "M-10: the static solutions are in equilibrium; M-11: they carry rigid-body motion",
        decide: decide::k10,
    },
    Rule {
        id: RuleId::K11,
        leaves_out: "modes above the cut-off, where the job leaves their number to the band or to what is accepted",
        kind: Kind::Always,
        because: "nothing else says how many are kept; a mode answers beyond its frequency as statics does, which the basis has",
        guard: "M-06: a count up to the cut-off; M-20 and M-24: response and frequencies in the band",
        decide: decide::k11,
    },
    Rule {
        id: RuleId::K12,
        leaves_out: "modes below the band",
        kind: Kind::Struck,
        because: "a mode that is left out is not gone: the constraint modes bring its motion back, stiffer and at another frequency, \
                  which may lie in the band",
        guard: "none is needed",
        decide: decide::k12,
    },
    Rule {
        id: RuleId::K13,
        leaves_out: "inertia relief, where nothing accelerates the whole",
        kind: Kind::Omission,
        because: "the columns answer to unit accelerations alone; the interface keeps every bit, and modes are no longer made orthogonal to what is left out",
        guard: "M-18: what the deflection under unit accelerations lacks is shown",
        decide: decide::k13,
    },
    Rule {
        id: RuleId::K14,
        leaves_out: "inertia relief of directions in which gravity does not act",
        kind: Kind::Omission,
        because: "the answer to a sum of accelerations is the sum of the answers; the interface keeps every bit, and modes are no longer made orthogonal to what is left out",
        guard: "M-18: what the deflection under unit accelerations lacks is shown",
        decide: decide::k14,
    },
    Rule {
        id: RuleId::K15,
        leaves_out: "solves for loads that act on the interface alone",
        kind: Kind::Always,
        because: "K_II⁻¹ f_I = 0 of f_I = 0: the constraint modes have the whole answer",
        guard: "M-27: the static answer to every load",
        decide: decide::k15,
    },
    Rule {
        id: RuleId::K16,
        leaves_out: "rows of the basis that `write` does not ask for",
        kind: Kind::Always,
        because: "rows of Ψ are independent of each other",
        guard: "M-26: the file holds the rows asked for; M-11 of the file: they carry rigid-body motion",
        decide: decide::k16,
    },
    Rule {
        id: RuleId::K17,
        leaves_out: "storage of the constraint modes, where they are large and no row of them is asked for",
        kind: Kind::WithinBars,
        because: "−K_II⁻¹K_IB and its transpose are half a solve each; sums over the interior are made in another order",
        guard: "M-32: energies of random motions by K̂ and M̂ against those of the whole model",
        decide: decide::k17,
    },
    Rule {
        id: RuleId::K18,
        leaves_out: "half the digits of recovered rows",
        kind: Kind::Always,
        because: "the deformation alone is applied to them, to which the client adds the rigid-body motion",
        guard: "the range of single precision is refused where it is left (E-RECOVERY-RANGE)",
        decide: decide::k18,
    },
    Rule {
        id: RuleId::K19,
        leaves_out: "inertia shape integrals",
        kind: Kind::Always,
        because: "the motion formalism takes constant K̂, M̂ and Û (paper, section 3)",
        guard: "none is needed: no output holds them",
        decide: decide::k19,
    },
    Rule {
        id: RuleId::K20,
        leaves_out: "modes that nothing starts and nothing sees, where the scene chooses the modes or names outputs; columns of the basis that \
                     others span, always",
        kind: Kind::WithinBars,
        because: "a mode at rest at the interface, without reaction there, on which no load does work, is uncoupled from all other \
                  coordinates: it stays at rest. A space is the same without columns that others span",
        guard: "M-35: what starts or sees each of them, and what the reduced matrices tie it to, against rounding; M-14: the modes are still \
                eigenpairs of the reduced model",
        decide: decide::k20,
    },
    Rule {
        id: RuleId::K21,
        leaves_out: "fill-in between parts that the interface separates",
        kind: Kind::WithinBars,
        because: "K_II is block-diagonal in its connected parts, and so is L",
        guard: "no supernode of the factor takes columns of two parts",
        decide: decide::k21,
    },
    Rule {
        id: RuleId::K22,
        leaves_out: "repeated sectors of cyclic structures",
        kind: Kind::Struck,
        because: "the matrices of meshed sectors are seldom equal to the bit, so that a sector would be a model of its own; and \
                  nodal diameters need complex pencils that nothing else here has",
        guard: "none is needed",
        decide: decide::k22,
    },
    Rule {
        id: RuleId::K23,
        leaves_out: "factors, counts, modes and responses that an earlier run with the same cache has computed of the same numbers, \
                     or for more than is asked",
        kind: Kind::Always,
        because: "they are found by a digest of these numbers and of the program, so that they have the same bits; a part of more is \
                  right to its error bars",
        guard: "a digest of each entry: what is damaged is computed anew; a part is taken below a count that agrees, a response where its \
                residual is small at every sample",
        decide: decide::k23,
    },
    Rule {
        id: RuleId::K24,
        leaves_out: "the factor of an unchanged K, where the values of M have changed",
        kind: Kind::Always,
        because: "the factor at shift zero is found by a digest of K and of where M has entries",
        guard: "a digest of each entry, as for K-23",
        decide: decide::k24,
    },
    Rule {
        id: RuleId::K25,
        leaves_out: "proofs that the job does not ask for",
        kind: Kind::Always,
        because: "a proof changes no result",
        guard: "the report says what is not proved",
        decide: decide::k25,
    },
    Rule {
        id: RuleId::K26,
        leaves_out: "the sparse path, of small models",
        kind: Kind::Struck,
        because: "a model of 3000 dofs takes a fraction of a second on it, and a second path would have to be tested as the first is",
        guard: "none is needed",
        decide: decide::k26,
    },
    Rule {
        id: RuleId::K27,
        leaves_out: "entries of M that are not there",
        kind: Kind::Always,
        because: "products take the entries that are stored; M is never factored by itself",
        guard: "none is needed: there is no other path",
        decide: decide::k27,
    },
    Rule {
        id: RuleId::K28,
        leaves_out: "the damping matrix, where none is asked for; its projection, where it is proportional",
        kind: Kind::Always,
        because: "αM̂ + βK̂ is the projection of αM + βK",
        guard: "M-28: damping of the file against that of the model",
        decide: decide::k28,
    },
    Rule {
        id: RuleId::K29,
        leaves_out: "sorting and merging of files that are sorted; the second triangle of symmetric ones",
        kind: Kind::Always,
        because: "an order is seen in the pass that reads the entries",
        guard: "every row is checked to ascend before it is used",
        decide: decide::k29,
    },
    Rule {
        id: RuleId::K30,
        leaves_out: "outputs that the job does not ask for",
        kind: Kind::Always,
        because: "no output depends on another",
        guard: "none is needed",
        decide: decide::k30,
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rule_stands_at_its_number() {
        for (at, rule) in RULES.iter().enumerate() {
            assert_eq!(rule.id as usize, at, "{}", rule.id.name());
            assert_eq!(rule.id.name(), format!("K-{}", at + 1));
        }
    }
}
