//! A human of CMU's bones.

/// Name, parent, direction, length, axis and degrees of freedom.
type Bone = (
    &'static str,
    &'static str,
    [f64; 3],
    f64,
    [f64; 3],
    &'static str,
);

#[rustfmt::skip]
const BONES: [Bone; 26] = [
    ("lhipjoint", "root", [0.65, -0.71, 0.25], 2.5, [0.0, 0.0, 0.0], ""),
    ("lfemur", "lhipjoint", [0.34202, -0.939693, 0.0], 7.6, [0.0, 0.0, 20.0], "rx ry rz"),
    ("ltibia", "lfemur", [0.34202, -0.939693, 0.0], 7.3, [0.0, 0.0, 20.0], "rx"),
    ("lfoot", "ltibia", [0.09, -0.24, 0.966], 2.2, [-90.0, 0.0, 20.0], "rx rz"),
    ("ltoes", "lfoot", [0.0, 0.0, 1.0], 1.1, [-90.0, 0.0, 20.0], "rx"),
    ("rhipjoint", "root", [-0.65, -0.72, 0.25], 2.5, [0.0, 0.0, 0.0], ""),
    ("rfemur", "rhipjoint", [-0.34202, -0.939693, 0.0], 7.6, [0.0, 0.0, -20.0], "rx ry rz"),
    ("rtibia", "rfemur", [-0.34202, -0.939693, 0.0], 7.2, [0.0, 0.0, -20.0], "rx"),
    ("rfoot", "rtibia", [-0.1, -0.28, 0.95], 2.2, [-90.0, 0.0, -20.0], "rx rz"),
    ("rtoes", "rfoot", [0.0, 0.0, 1.0], 1.1, [-90.0, 0.0, -20.0], "rx"),
    ("lowerback", "root", [0.01, 0.998, -0.07], 2.06, [0.0, 0.0, 0.0], "rx ry rz"),
    ("upperback", "lowerback", [0.0, 1.0, -0.03], 2.06, [0.0, 0.0, 0.0], "rx ry rz"),
    ("thorax", "upperback", [0.0, 1.0, 0.0], 2.07, [0.0, 0.0, 0.0], "rx ry rz"),
    ("lowerneck", "thorax", [0.0, 0.995, 0.095], 1.57, [0.0, 0.0, 0.0], "rx ry rz"),
    ("upperneck", "lowerneck", [0.02, 0.998, -0.06], 1.56, [0.0, 0.0, 0.0], "rx ry rz"),
    ("head", "upperneck", [0.01, 0.999, -0.03], 1.63, [0.0, 0.0, 0.0], "rx ry rz"),
    ("lclavicle", "thorax", [0.968, 0.247, -0.047], 3.66, [0.0, 0.0, 0.0], "ry rz"),
    ("lhumerus", "lclavicle", [1.0, 0.0, 0.0], 4.87, [180.0, -30.0, -90.0], "rx ry rz"),
    ("lradius", "lhumerus", [1.0, 0.0, 0.0], 3.36, [180.0, -30.0, -90.0], "rx"),
    ("lwrist", "lradius", [1.0, 0.0, 0.0], 1.68, [0.0, 90.0, 90.0], "ry"),
    ("lhand", "lwrist", [1.0, 0.0, 0.0], 0.66, [0.0, 90.0, 90.0], "rx rz"),
    ("rclavicle", "thorax", [-0.973, 0.211, -0.09], 3.6, [0.0, 0.0, 0.0], "ry rz"),
    ("rhumerus", "rclavicle", [-1.0, 0.0, 0.0], 5.03, [180.0, 30.0, 90.0], "rz ry rx"),
    ("rradius", "rhumerus", [-1.0, 0.0, 0.0], 3.36, [180.0, 30.0, 90.0], "rx"),
    ("rwrist", "rradius", [-1.0, 0.0, 0.0], 1.68, [0.0, -90.0, -90.0], "ry"),
    ("rhand", "rwrist", [-1.0, 0.0, 0.0], 0.73, [0.0, -90.0, -90.0], "rx rz"),
];

/// A human of CMU's bones; every number from a wave, so that all axes and orders matter.
pub(crate) fn human(frames: usize) -> (String, String) {
    let mut asf = String::from(
        ":version 1.10\n:units\n mass 1\n length 0.45\n angle deg\n:root\n order TX TY TZ RX RY RZ\n \
         axis XYZ\n position 0 0 0\n orientation 0 0 0\n:bonedata\n",
    );
    let mut tree = String::new();
    for (name, parent, [x, y, z], length, [a, b, c], dof) in BONES {
        asf += &format!("begin\n name {name}\n direction {x} {y} {z}\n length {length}\n");
        asf += &format!(" axis {a} {b} {c} XYZ\n");
        if !dof.is_empty() {
            asf += &format!(" dof {dof}\n");
        }
        asf += "end\n";
        tree += &format!("{parent} {name}\n");
    }
    asf += &format!(":hierarchy\nbegin\n{tree}end\n");

    let mut amc = String::from(":FULLY-SPECIFIED\n:DEGREES\n");
    let wave = |n: usize| 25.0 * (n as f64 * 1.7).sin();
    for frame in 0..frames {
        let [x, y, z] = [1.0, 17.0, 0.3 * frame as f64];
        amc += &format!("{}\nroot {x} {y} {z} 3 {} -4\n", frame + 1, wave(frame));
        for (bone, (name, .., dof)) in BONES.iter().enumerate() {
            let numbers = dof.split_whitespace().enumerate();
            let numbers: String = numbers
                .map(|(at, _)| format!(" {:.6}", wave(frame + 7 * bone + 3 * at)))
                .collect();
            if !numbers.is_empty() {
                amc += &format!("{name}{numbers}\n");
            }
        }
    }
    (asf, amc)
}
