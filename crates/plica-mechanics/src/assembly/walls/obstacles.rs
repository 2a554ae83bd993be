//! Contact of the walls with rigid obstacles.
//!
//! Contact adds ∫ b(g) dA₀ to the energy, with g the distance of a point of a wall from the obstacle, b the
//! [`Barrier`] and dA₀ the area at rest. Its force on the point is −b′(g) ∇g per area.

use super::super::SplineTube;
use super::super::blocks::Block;
use super::super::kinematics::Vector;
use super::LoadedWall;
use super::friction::ObstacleFriction;
use crate::rings::shortest_arc;
use crate::tube::{Distance, Load, Obstacle, ObstacleShape, Placement, turned};

/// An obstacle in the places where the cyclic sectors of the tube repeat it.
#[derive(Clone, Debug)]
pub struct PlacedObstacle {
    /// Its number in the tube.
    pub number: usize,
    copies: Vec<Copy>,
    /// 1 for a sector that is the whole tube, else 0.
    whole: f64,
}

/// One of the copies of an obstacle.
#[derive(Clone, Debug)]
pub(super) struct Copy {
    pub shape: ObstacleShape,
    pub placement: Placement,
    /// Sine and cosine of its angle from the first copy.
    sin_cos: (f64, f64),
}

/// Contact of a tube with one obstacle.
#[derive(Clone, Debug, PartialEq)]
pub struct ObstacleContact {
    /// Energy of contact, in E·D³.
    pub energy: f64,
    /// Sum of the sizes of the contact forces, in E·D².
    pub force: f64,
    /// Resultant of the contact forces on the obstacle, and of friction where that is known, (z, x, y), in E·D²; on one of
    /// its copies, if the cyclic sectors of the tube repeat it.
    pub reaction: [f64; 3],
    /// Number of its copies. Energy, force and area are those of all.
    pub copies: usize,
    /// Derivative of the energy of contact by the radius, in E·D²: the work, per unit of radius, that it takes to change
    /// the radius against the contact.
    pub radius_force: f64,
    /// Area at rest of the wall within the range of contact, in D².
    pub area: f64,
    /// Smallest distance of the quadrature points of the walls, in D.
    pub gap: f64,
    /// Axial positions at rest of the first and the last point in contact, in D; none without contact.
    pub from_to: Option<[f64; 2]>,
    /// First and last angle at rest of the shortest arc with all points in contact, in radians, modulo the angle of the sector:
    /// see [`shortest_arc`]. Zero without contact; none of an axisymmetric tube.
    pub angles: Option<[f64; 2]>,
    /// Friction, where the history of the state is known; see [`SplineTube::friction_on_obstacles`].
    pub friction: Option<ObstacleFriction>,
}

/// Contact at one point of a wall: energy, its derivatives over the position in the frame of its element, per area at rest.
#[derive(Clone, Debug, Default)]
pub struct PointContact {
    pub energy: f64,
    pub slope: Vector<f64>,
    pub curvature: Block<f64>,
}

impl SplineTube {
    /// Returns the obstacles under a load, repeated as the sector is.
    pub(super) fn placed_obstacles(&self, load: &Load) -> Vec<PlacedObstacle> {
        let obstacles = self.tube.obstacles.iter().zip(&load.obstacles);
        let placed = |(number, (obstacle, placement)): (usize, (&Obstacle, &Placement))| {
            let repeats = match obstacle.is_axisymmetric(placement) {
                true => 1,
                false => self.sector.around / self.sector.rings,
            };
            let angle = std::f64::consts::TAU / repeats as f64;
            let copy = |i: usize| {
                let sin_cos = (i as f64 * angle).sin_cos();
                Copy {
                    shape: obstacle.shape.turned(sin_cos),
                    placement: placement.turned(sin_cos),
                    sin_cos,
                }
            };
            PlacedObstacle {
                whole: if self.sector.around == self.sector.rings {
                    1.0
                } else {
                    0.0
                },
                number,
                copies: (0..repeats).map(copy).collect(),
            }
        };
        obstacles.enumerate().map(placed).collect()
    }

    /// Returns the contact of a state with each obstacle of the tube.
    pub fn obstacle_contacts(&self, load: &Load, u: &[f64]) -> Vec<ObstacleContact> {
        let nothing = ObstacleContact {
            energy: 0.0,
            force: 0.0,
            reaction: [0.0; 3],
            copies: 1,
            radius_force: 0.0,
            area: 0.0,
            gap: f64::INFINITY,
            from_to: None,
            angles: None,
            friction: None,
        };
        let mut contacts = vec![nothing; self.tube.obstacles.len()];
        if contacts.is_empty() {
            return contacts;
        }
        let mut angles: Vec<Vec<f64>> = vec![vec![]; contacts.len()];
        for wall in self.loaded_walls(load) {
            self.visit_wall(&wall, [u], |point, [position], area| {
                for obstacle in &wall.obstacles {
                    let sum = &mut contacts[obstacle.number];
                    if obstacle.add_to(sum, position, (point.z, area), &wall) {
                        let turns = point.element as f64 + point.around.s - 0.5;
                        angles[obstacle.number].push(turns * self.sector.angle());
                    }
                }
            });
        }
        if self.sector.rings > 1 {
            let (element, rings) = (self.sector.angle(), self.sector.rings as f64);
            for (contact, angles) in contacts.iter_mut().zip(angles) {
                let arc = shortest_arc(angles, rings * element, element);
                contact.angles = Some(arc.unwrap_or_default());
            }
        }
        contacts
    }

    /// Returns sine and cosine of the angle of the frame of an element of the sector.
    pub(super) fn element_turn(&self, element: usize) -> (f64, f64) {
        (element as f64 * self.sector.angle()).sin_cos()
    }
}

impl LoadedWall {
    /// Returns the contact with all obstacles at a position in the frame of an element; none where nothing is near.
    pub(super) fn contact(
        &self,
        position: Vector<f64>,
        (sin, cos): (f64, f64),
    ) -> Option<PointContact> {
        let mut found: Option<PointContact> = None;
        let lab = turned(position, (sin, cos));
        for copy in self.obstacles.iter().flat_map(|obstacle| &obstacle.copies) {
            let Distance {
                gap,
                normal,
                curvature,
            } = copy.shape.distance(&copy.placement, lab);
            if gap >= self.barrier.range {
                continue;
            }
            let jet = self.barrier.continued(gap);
            let at = found.get_or_insert_default();
            at.energy += jet.value;
            let back = |vector: [f64; 3]| turned(vector, (-sin, cos));
            let normal = back(normal);
            // Rows, then columns.
            let curvature = transposed(curvature.map(back)).map(back);
            for i in 0..3 {
                at.slope[i] += jet.slope * normal[i];
                for j in 0..3 {
                    at.curvature[i][j] +=
                        jet.curvature * normal[i] * normal[j] + jet.slope * curvature[i][j];
                }
            }
        }
        found
    }
}

impl PointContact {
    /// Adds an energy with its derivatives in the frame of the sector; the frame of the element has a turn in it.
    pub(super) fn add(
        &mut self,
        energy: f64,
        slope: Vector<f64>,
        curvature: Block<f64>,
        (sin, cos): (f64, f64),
    ) {
        let back = |vector: [f64; 3]| turned(vector, (-sin, cos));
        // Rows, then columns.
        let (slope, curvature) = (back(slope), transposed(curvature.map(back)).map(back));
        self.energy += energy;
        for i in 0..3 {
            self.slope[i] += slope[i];
            for j in 0..3 {
                self.curvature[i][j] += curvature[i][j];
            }
        }
    }
}

impl PlacedObstacle {
    /// Returns its copies.
    pub(super) fn copies(&self) -> impl Iterator<Item = &Copy> {
        self.copies.iter()
    }

    /// Returns the share of the first copy in a force on a copy. The forces of all sectors across a single obstacle on the
    /// axis cancel.
    pub(super) fn on_first_copy(&self, copy: &Copy, force: Vector<f64>) -> Vector<f64> {
        let (sin, cos) = copy.sin_cos;
        let [along, x, y] = turned(force, (-sin, cos));
        let across = match self.copies.len() {
            1 => self.whole,
            _ => 1.0,
        };
        let share = 1.0 / self.copies.len() as f64;
        [along, across * x, across * y].map(|x| share * x)
    }

    /// Adds the contact of a point with area `area` and the axial position `z` at rest. Returns whether there is one.
    fn add_to(
        &self,
        sum: &mut ObstacleContact,
        position: [f64; 3],
        (z, area): (f64, f64),
        wall: &LoadedWall,
    ) -> bool {
        let mut touches = false;
        sum.copies = self.copies.len();
        for copy in &self.copies {
            let Distance { gap, normal, .. } = copy.shape.distance(&copy.placement, position);
            sum.gap = sum.gap.min(gap);
            if gap >= wall.barrier.range {
                continue;
            }
            touches = true;
            let jet = wall.barrier.continued(gap);
            sum.energy += area * jet.value;
            sum.force -= area * jet.slope;
            sum.radius_force += area * jet.slope * copy.shape.radius_slope();
            sum.area += area;
            // Of the first copy. The forces of all sectors across a single obstacle on the axis cancel.
            let (sin, cos) = copy.sin_cos;
            let [along, x, y] = turned(normal, (-sin, cos));
            let across = match sum.copies {
                1 => self.whole,
                _ => 1.0,
            };
            let share = area * jet.slope / sum.copies as f64;
            for (sum, part) in sum.reaction.iter_mut().zip([along, across * x, across * y]) {
                *sum += share * part;
            }
            let [from, to] = sum.from_to.unwrap_or([z, z]);
            sum.from_to = Some([from.min(z), to.max(z)]);
        }
        touches
    }
}

fn transposed(a: Block<f64>) -> Block<f64> {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}
