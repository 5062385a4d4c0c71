// The place along the channel that all views look at.

let place = $state(0);

export const shared = {
  get x() {
    return place;
  },
  set x(value: number) {
    place = value;
  },
};
